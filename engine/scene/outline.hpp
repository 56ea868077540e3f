// Where the ground and its sides are, as far as the scene's description says it without a mesh.
#pragma once

#include "scene/scene.hpp"

#include <optional>

namespace talus {

/// A rectangle that may be unbounded.
struct Box {
    double x_from = -std::numeric_limits<double>::infinity();
    double x_to = std::numeric_limits<double>::infinity();
    double y_from = -std::numeric_limits<double>::infinity();
    double y_to = std::numeric_limits<double>::infinity();
};

[[nodiscard]] Box intersection(const Box& a, const Box& b);
[[nodiscard]] bool is_empty(const Box& box);

/// Height of a profile with increasing x; constant beyond its ends.
[[nodiscard]] double height_at(const std::vector<Place>& profile, double x);

/// The ground's sides and extent. Refers to the ground.
class Outline {
public:
    explicit Outline(const Ground& ground);

    /// The names of the sides that a boundary may have, none where a mesh file may name more.
    [[nodiscard]] std::vector<std::string> side_names() const;

    /// Whether any part of a side lies in the box: more than a point of it, where the side is longer than that. The sides of a
    /// mesh are not known before it is built: there the mesh's bounds decide, and nothing is known of a file.
    [[nodiscard]] bool reaches(const std::string& side, const Box& box) const;

    /// Whether a place lies in the ground, to 1e-9 of its size; in its bounds for a mesh, and always for a mesh file.
    [[nodiscard]] bool inside(Place place) const;

private:
    const Ground& ground;
    std::optional<Box> bounds;  ///< none for a mesh file
};

}  // namespace talus

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
[[nodiscard]] bool contains(const Box& box, Place place);

/// Height of a profile with increasing x; constant beyond its ends.
[[nodiscard]] double height_at(const std::vector<Place>& profile, double x);

/// The names of the sides that a boundary may have, none where a mesh file may name more.
[[nodiscard]] std::vector<std::string> side_names(const Ground& ground);

/// The line of a side: two places or more, one in a column. None for a mesh, whose sides are not known before it is built.
[[nodiscard]] std::vector<Place> side_line(const Ground& ground, const std::string& side);

/// Whether a part of the line lies in the box: more than a point of it, where it is longer than that.
[[nodiscard]] bool passes(const std::vector<Place>& line, const Box& box);

/// The rectangle around the ground; none for a mesh file.
[[nodiscard]] std::optional<Box> bounds(const Ground& ground);

/// Whether a place lies in the ground, to 1e-9 of its size; in its bounds for a mesh, and always for a mesh file.
[[nodiscard]] bool inside(const Ground& ground, Place place);

}  // namespace talus

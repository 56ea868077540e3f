// What a Gmsh file says, before any of it is given a meaning. Format: Gmsh reference manual, "MSH file format" (4.1)
// and its legacy version 2.2; ASCII.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace talus {

struct GmshNode {
    int64_t tag;
    double x;
    double y;
    double z;
};

struct GmshElement {
    int32_t line;                  ///< of the file
    int32_t size;                  ///< nodes: 2 (line), 3 (triangle) or 4 (quad)
    int64_t owner;                 ///< 2.2: physical group, 0 for none; 4.1: entity
    std::array<int64_t, 4> nodes;  ///< tags
    [[nodiscard]] int32_t dimension() const { return size == 2 ? 1 : 2; }
};

/// Dimension and tag of a physical group or of an entity.
using GmshKey = std::pair<int64_t, int64_t>;

struct GmshName {
    int32_t line;
    std::string text;
};

struct GmshFile {
    std::string name;           ///< of the file, for messages
    bool has_entities = false;  ///< 4.1: elements belong to entities, and these to physical groups
    std::map<GmshKey, GmshName> physical_names;
    std::map<GmshKey, int64_t> entity_group;  ///< physical group of an entity, 0 for none
    std::vector<GmshNode> nodes;              ///< by increasing tag
    std::vector<GmshElement> elements;        ///< lines, triangles and quads; points are left out
};

/// Reads the text of a Gmsh file. Throws Error(invalid_scene) naming the file, the line and what is allowed.
[[nodiscard]] GmshFile parse_gmsh(std::string_view text, const std::string& name);

/// The beginning of a message about a line of the file.
[[nodiscard]] std::string gmsh_place(const std::string& name, int32_t line);

}  // namespace talus

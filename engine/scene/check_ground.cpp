#include "scene/check.hpp"
#include "scene/outline.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace talus {
namespace {

constexpr double most_cells = 5e6;

void check_soil_name(const Check& check, const std::string& name, const std::vector<Soil>& soils) {
    if (name.empty()) return check.say("is missing; a layer needs the name of a soil");
    if (std::any_of(soils.begin(), soils.end(), [&](const Soil& soil) { return soil.name == name; })) return;
    std::vector<std::string> names;
    for (const Soil& soil : soils) names.push_back(soil.name);
    const std::string near = nearest(name, names);
    check.say("'" + name + "' is no soil; the soils are " + joined(names) +
              (near.empty() ? "" : " (did you mean " + near + "?)"));
}

// --- column ----------------------------------------------------------------------------------------------------------

void check_column(const Check& check, const ColumnGround& column, const std::vector<Soil>& soils) {
    check.at("height").needed(given_positive(column.height), "a column");
    check.at("layers").needed(!column.layers.empty(), "a column");
    const double cell = column.height / std::max(column.cells, 1);
    for (size_t i = 0; i < column.layers.size(); ++i) {
        const Check layer = check.at("layers", i);
        const bool last = i + 1 == column.layers.size();
        const double top = i == 0 ? column.height : column.layers[i].top;
        const double bottom = last ? 0 : column.layers[i + 1].top;
        check_soil_name(layer.at("soil"), column.layers[i].soil, soils);
        layer.at("top").require(i == 0 || given(top), "is missing; a layer below the first needs it");
        layer.at("top").require(i > 0 || !given(column.layers[0].top) || column.layers[0].top == column.height,
                                "= " + value_text(column.layers[0].top) + " m: must be the column's height, " +
                                    value_text(column.height) + " m, or be left out");
        if (top <= bottom) {
            layer.say("reaches from " + value_text(top) + " m down to " + value_text(bottom) +
                      " m: " + (last ? "must end above the base" : "layers must not cross"));
        } else if (top - bottom < cell * (1 - 1e-9)) {
            layer.say("is " + value_text(top - bottom) + " m thick: must be at least a cell, " + value_text(cell) +
                      " m");
        }
    }
}

// --- section ---------------------------------------------------------------------------------------------------------

/// Whether it is a profile: two places or more, x increasing.
bool check_profile(const Check& check, const std::vector<Place>& profile) {
    if (profile.size() < 2) {
        check.say("has " + std::to_string(profile.size()) + " places; a profile needs 2 or more");
        return false;
    }
    for (size_t i = 1; i < profile.size(); ++i) {
        if (profile[i][0] > profile[i - 1][0]) continue;
        check.say("place " + std::to_string(i) + " at x = " + value_text(profile[i][0]) +
                  " m: must be right of the one before, x = " + value_text(profile[i - 1][0]) + " m");
        return false;
    }
    return true;
}

bool check_ends(const Check& check, const std::vector<Place>& profile, const std::vector<Place>& terrain) {
    const bool same = profile.front()[0] == terrain.front()[0] && profile.back()[0] == terrain.back()[0];
    check.require(same, "reaches from x = " + value_text(profile.front()[0]) + " to " + value_text(profile.back()[0]) +
                            " m: must reach as far as the terrain, " + value_text(terrain.front()[0]) + " to " +
                            value_text(terrain.back()[0]) + " m");
    return same;
}

struct Gap {
    double least;     ///< m, of upper above lower
    double greatest;  ///< m
    double x;         ///< of the least
};

Gap gap(const std::vector<Place>& upper, const std::vector<Place>& lower) {
    Gap result{std::numeric_limits<double>::infinity(), 0, 0};
    for (const auto* profile : {&upper, &lower}) {  // lines between vertices: both extremes are at vertices
        for (const Place& vertex : *profile) {
            const double height = height_at(upper, vertex[0]) - height_at(lower, vertex[0]);
            result.greatest = std::max(result.greatest, height);
            if (height < result.least) result = {height, result.greatest, vertex[0]};
        }
    }
    return result;
}

void check_above(const Check& check, const std::vector<Place>& profile, const std::vector<Place>& lower,
                 const std::string& lower_name) {
    const Gap room = gap(profile, lower);
    check.require(room.least >= 0, "is " + value_text(-room.least) + " m below " + lower_name +
                                       " at x = " + value_text(room.x) + " m: must not cross it");
}

/// The layers' tops in order, each between the one above and the base.
void check_layers(const Check& check, const SectionGround& section, const std::vector<Soil>& soils,
                  bool profiles_hold) {
    check.at("layers").needed(!section.layers.empty(), "a section");
    const std::vector<Place>* above = &section.terrain;
    std::string above_name = "the terrain";
    for (size_t i = 0; i < section.layers.size(); ++i) {
        const Check layer = check.at("layers", i);
        const std::vector<Place>& top = section.layers[i].top;
        check_soil_name(layer.at("soil"), section.layers[i].soil, soils);
        if (i == 0) {
            layer.at("top").require(top.empty(),
                                    "is given; must be left out of the first layer, whose top is the terrain");
            continue;
        }
        if (!check_profile(layer.at("top"), top) || !profiles_hold ||
            !check_ends(layer.at("top"), top, section.terrain))
            continue;
        const Gap below = gap(*above, top);
        layer.at("top").require(below.least >= 0, "is " + value_text(-below.least) + " m above " + above_name +
                                                      " at x = " + value_text(below.x) + " m: must not cross it");
        check_above(layer.at("top"), top, section.base, "the base");
        check.at("layers", i - 1).require(below.greatest > 0, "has no thickness anywhere");
        above = &top;
        above_name = item_path("layers", i) + ".top";
    }
    if (section.layers.size() > 1 && profiles_hold && gap(*above, section.base).greatest <= 0) {
        check.at("layers", section.layers.size() - 1).say("has no thickness anywhere");
    }
}

/// Rows of cells down to a depth: equal ones, growing ones, equal ones again; or, without a growth, equal ones and evenly growing ones.
double row_count(const SectionGround& section, double depth) {
    const double graded_depth = std::min(section.graded_depth, depth);
    const double graded = graded_depth / section.surface_cell_height;
    const double gain = section.largest_cell_height - section.surface_cell_height;
    const double range = std::log(section.largest_cell_height / section.surface_cell_height);
    if (!(section.growth > 0) && gain > 0) return graded + (depth - graded_depth) / gain * range;
    const double growing = section.growth > 1 ? range / std::log(section.growth) : 0;
    const double smallest = section.growth > 1 ? section.largest_cell_height : section.surface_cell_height;
    return graded + growing + (depth - graded_depth) / smallest;
}

void check_cells(const Check& check, const SectionGround& section, bool profiles_hold) {
    check.at("columnWidth").needed(given_positive(section.column_width), "a section");
    check.at("surfaceCellHeight").needed(given_positive(section.surface_cell_height), "a section");
    check.at("largestCellHeight").needed(given_positive(section.largest_cell_height), "a section");
    if (!(section.column_width > 0 && section.surface_cell_height > 0 && section.largest_cell_height > 0)) return;

    check.at("largestCellHeight")
        .require(section.largest_cell_height >= section.surface_cell_height,
                 "= " + value_text(section.largest_cell_height) + " m: must be at least surfaceCellHeight, " +
                     value_text(section.surface_cell_height) + " m");
    check.at("bendColumnWidth")
        .require(!(section.bend_column_width > section.column_width), "= " + value_text(section.bend_column_width) +
                                                                          " m: must be at most columnWidth, " +
                                                                          value_text(section.column_width) + " m");
    if (!profiles_hold) return;
    const double width = section.terrain.back()[0] - section.terrain.front()[0];
    const double depth = gap(section.terrain, section.base).greatest;
    const auto at_most = [&](const char* name, double value, const std::string& what, double most) {
        check.at(name).require(
            !(value > most), "= " + value_text(value) + " m: must be at most " + what + ", " + value_text(most) + " m");
    };
    at_most("columnWidth", section.column_width, "the section's width", width);
    at_most("surfaceCellHeight", section.surface_cell_height, "the section's depth", depth);
    const double cells = width / section.column_width * row_count(section, depth);
    check.require(!(cells > most_cells), "makes some " + value_text(std::round(cells)) + " cells; at most " +
                                             value_text(most_cells) +
                                             " are allowed (columnWidth and surfaceCellHeight are in m)");
}

void check_section(const Check& check, const SectionGround& section, const std::vector<Soil>& soils) {
    const bool terrain_holds = check_profile(check.at("terrain"), section.terrain);
    const bool base_holds = check_profile(check.at("base"), section.base);
    const bool profiles_hold =
        terrain_holds && base_holds && check_ends(check.at("base"), section.base, section.terrain);
    if (profiles_hold) {
        const Gap depth = gap(section.terrain, section.base);
        check.at("base").require(depth.least > 0, "is " + value_text(-depth.least) + " m above the terrain at x = " +
                                                      value_text(depth.x) + " m: must be below it");
    }
    check_layers(check, section, soils, profiles_hold);
    check_cells(check, section, profiles_hold);
}

// --- mesh ------------------------------------------------------------------------------------------------------------

/// Twice the areas of the triangles at a cell's corners are its Jacobian there: all positive in a convex, counter-clockwise cell.
double least_corner(const std::vector<double>& position, const int32_t* node, size_t count) {
    double least = std::numeric_limits<double>::infinity();
    for (size_t corner = 0; corner < count; ++corner) {
        std::array<std::array<double, 2>, 3> place{};
        for (size_t k = 0; k < 3; ++k) {
            const auto first = 2 * static_cast<size_t>(node[(corner + k) % count]);
            place[k] = {position[first], position[first + 1]};
        }
        const auto [a, b, c] = place;
        least = std::min(least, (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
    }
    return least;
}

void check_cell(const Check& check, const MeshGround& mesh, size_t cell) {
    const int64_t nodes = static_cast<int64_t>(mesh.position.size() / 2);
    const auto first = static_cast<size_t>(mesh.cell_start[cell]);
    const auto count = static_cast<size_t>(mesh.cell_start[cell + 1]) - first;
    for (size_t i = first; i < first + count; ++i) {
        const int32_t node = mesh.cell_nodes[i];
        if (node >= 0 && node < nodes) continue;
        return check.at("cellNodes", i)
            .say("= " + std::to_string(node) + " (in cell " + std::to_string(cell) +
                 "): must be a node's number, 0 to " + std::to_string(nodes - 1));
    }
    const double corner = least_corner(mesh.position, &mesh.cell_nodes[first], count);
    if (corner > 0) return;
    check.at("cellNodes", first)
        .say("cell " + std::to_string(cell) +
             " is inverted or flat: its nodes must go counter-clockwise around a convex cell "
             "(twice the area at its worst corner is " +
             value_text(corner) + " m2)");
}

/// Whether the offsets can be followed.
bool check_offsets(const Check& check, const MeshGround& mesh) {
    const Check start = check.at("cellStart");
    const size_t cells = mesh.cell_soil.size();
    check_length(start, mesh.cell_start.size(), cells + 1, "cellSoil, and one more");
    if (mesh.cell_start.size() != cells + 1 || cells == 0) return false;
    if (mesh.cell_start.front() != 0) start.item(0).say("= " + std::to_string(mesh.cell_start.front()) + ": must be 0");
    bool holds = mesh.cell_start.front() == 0;
    for (size_t cell = 0; cell < cells; ++cell) {
        const int64_t count = static_cast<int64_t>(mesh.cell_start[cell + 1]) - mesh.cell_start[cell];
        if (count == 3 || count == 4) continue;
        check.at("cellStart", cell + 1)
            .say("= " + std::to_string(mesh.cell_start[cell + 1]) + ": gives cell " + std::to_string(cell) + " " +
                 std::to_string(count) + " nodes; must be 3 or 4");
        holds = false;
    }
    const auto end = static_cast<size_t>(std::max(mesh.cell_start.back(), 0));
    if (holds) check_length(check.at("cellNodes"), mesh.cell_nodes.size(), end, "cellStart's end");
    return holds && mesh.cell_nodes.size() == end;
}

void check_mesh_arrays(const Check& check, const MeshGround& mesh, size_t soils) {
    check.at("position").needed(mesh.position.size() >= 6, "a mesh of one cell or more without a file");
    check.at("position")
        .require(mesh.position.size() % 2 == 0,
                 "has " + std::to_string(mesh.position.size()) + " numbers; must be two a node");
    check.at("cellSoil").needed(!mesh.cell_soil.empty(), "a mesh without a file");
    for (size_t cell = 0; cell < mesh.cell_soil.size(); ++cell) {
        const int32_t soil = mesh.cell_soil[cell];
        if (soil >= 0 && static_cast<size_t>(soil) < soils) continue;
        check.at("cellSoil", cell)
            .say("= " + std::to_string(soil) + ": must be a soil's number, 0 to " + std::to_string(soils - 1));
    }
    if (!check_offsets(check, mesh)) return;
    for (size_t cell = 0; cell < mesh.cell_soil.size(); ++cell) check_cell(check, mesh, cell);
}

void check_mesh(const Check& check, const MeshGround& mesh, size_t soils) {
    if (mesh.file.empty()) return check_mesh_arrays(check, mesh, soils);
    check.at("position").unused(!mesh.position.empty(), "a mesh from a file");
    check.at("cellStart").unused(!mesh.cell_start.empty(), "a mesh from a file");
    check.at("cellNodes").unused(!mesh.cell_nodes.empty(), "a mesh from a file");
    check.at("cellSoil").unused(!mesh.cell_soil.empty(), "a mesh from a file");
}

}  // namespace

void check_ground(const Check& scene_check, const Scene& scene) {
    const Check check = scene_check.at("ground");
    const Ground& ground = scene.ground;
    const bool absent = ground.kind == GroundKind::column && ground.column.height == 0 && ground.column.cells == 0 &&
                        ground.column.layers.empty();
    if (absent) return check.say("is missing; must have one of column, section, mesh");
    switch (ground.kind) {
        case GroundKind::column: return check_column(check.at("column"), ground.column, scene.soils);
        case GroundKind::section: return check_section(check.at("section"), ground.section, scene.soils);
        case GroundKind::mesh: return check_mesh(check.at("mesh"), ground.mesh, scene.soils.size());
    }
}

void check_probes(const Check& scene_check, const Scene& scene) {
    check_names(scene_check, "probes", scene.probes, true);
    const Outline outline(scene.ground);
    const bool column = scene.ground.kind == GroundKind::column;
    for (size_t i = 0; i < scene.probes.size(); ++i) {
        const Place place = scene.probes[i].place;
        const std::string at = joined({value_text(place[0]), value_text(place[1])});
        scene_check.at("probes", i)
            .at("place")
            .require(outline.inside(place),
                     "(" + at + ") m is outside the ground" + (column ? "; x is 0 in a column" : ""));
    }
}

}  // namespace talus

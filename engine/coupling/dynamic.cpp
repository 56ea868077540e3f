#include "coupling/dynamic.hpp"

#include "background/locate.hpp"
#include "error.hpp"
#include "ground/sides.hpp"
#include "points/quadrature.hpp"
#include "points/seeding.hpp"
#include "scene/problems.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace talus {
namespace {

constexpr int64_t substeps_a_look = 16;
constexpr double most_nodes = 2e7;  // of the grid: 1.3 GB

double sin_degrees(double angle) { return std::sin(angle * std::numbers::pi / 180); }
double tan_degrees(double angle) { return std::tan(angle * std::numbers::pi / 180); }

// --- from the scene --------------------------------------------------------------------------------------------------

ExplicitSoil explicit_soil(const Solid& solid) {
    ExplicitSoil soil;
    soil.elastic = elasticity(solid.young_modulus, solid.poisson_ratio);
    soil.yields = solid.model == SolidModel::mohr_coulomb;
    if (!soil.yields) return soil;
    soil.strength =
        mohr_coulomb(shear_strength(solid.strength, 0.0, 1.0), solid.dilation_angle, solid.tensile_strength);
    if (solid.softening.slip <= 0) return soil;
    soil.residual_cohesion = solid.softening.residual_cohesion;
    soil.residual_sin_friction = sin_degrees(solid.softening.residual_friction_angle);
    soil.softening_slip = solid.softening.slip;
    return soil;
}

std::vector<ExplicitSoil> explicit_soils(const Scene& scene) {
    std::vector<ExplicitSoil> soils;
    for (const Soil& soil : scene.soils) soils.push_back(explicit_soil(soil.solid));
    return soils;
}

/// The least coordinate of the ground along an axis, m.
double least_place(const Mesh& mesh, size_t axis) {
    double least = mesh.position[axis];
    for (size_t i = axis; i < mesh.position.size(); i += 2) least = std::min(least, mesh.position[i]);
    return least;
}

/// Where a side is a straight line across an axis; throws where it is none.
double place_of_side(const Mesh& mesh, int32_t side, size_t axis, const std::string& path) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Facet& facet : mesh.facets) {
        if (facet.side != side) continue;
        for (const int32_t node : {facet.node_a, facet.node_b}) {
            low = std::min(low, mesh.position[2 * static_cast<size_t>(node) + axis]);
            high = std::max(high, mesh.position[2 * static_cast<size_t>(node) + axis]);
        }
    }
    const double rounding = 1e-9 * (std::abs(low) + std::abs(high));
    if (high - low <= rounding) return low;
    throw Error(Status::invalid_scene, path + ": the side is not a straight line along an axis, from " +
                                           value_text(low) + " to " + value_text(high) +
                                           " m; that is not supported yet in a dynamic ground");
}

WallKind wall_kind(MotionCondition motion) {
    switch (motion) {
        case MotionCondition::roller: return WallKind::roller;
        case MotionCondition::fixed: return WallKind::fixed;
        case MotionCondition::friction: return WallKind::friction;
        default: return WallKind::none;
    }
}

Wall find_wall(const Scene& scene, const Mesh& mesh, SideNumber side) {
    const size_t axis = side == side_base ? 1 : 0;
    Wall wall{WallKind::none, least_place(mesh, axis), 0};
    for (size_t b = 0; b < scene.boundaries.size(); ++b) {
        const Boundary& boundary = scene.boundaries[b];
        if (!boundary.has_motion || boundary.side != mesh.sides[side]) continue;
        wall.kind = wall_kind(boundary.motion);
        if (wall.kind == WallKind::none) continue;
        wall.place = place_of_side(mesh, side, axis, item_path("boundaries", b) + ".motion");
        if (wall.kind == WallKind::friction) wall.friction = tan_degrees(boundary.friction_angle);
    }
    return wall;
}

Walls find_walls(const Scene& scene, const Mesh& mesh) {
    return {find_wall(scene, mesh, side_left), find_wall(scene, mesh, side_right), find_wall(scene, mesh, side_base)};
}

/// At most the scene's, and such that two upright walls lie a whole number of cells apart.
double find_cell_size(const Scene& scene, const Walls& walls) {
    const double wanted = scene.dynamics.cell_size;
    if (walls.left.kind == WallKind::none || walls.right.kind == WallKind::none) return wanted;
    const double width = walls.right.place - walls.left.place;
    return width / std::max(1.0, std::ceil(width / wanted * (1 - 1e-12)));
}

// --- the points ------------------------------------------------------------------------------------------------------

/// Stress at a place, of the mesh's points; outside the mesh, where the middle of a piece of concave ground may lie, of the cell's first one.
std::array<double, 4> stress_at(const Mesh& mesh, const Points& points, const CellPlace& place, int32_t cell) {
    std::array<double, 4> stress{};
    const auto found = static_cast<size_t>(place.cell >= 0 ? place.cell : cell);
    const double* rows = points.skeleton_stress.data() + 4 * static_cast<size_t>(points.cell_start[found]);
    if (place.cell < 0) {
        std::copy_n(rows, 4, stress.begin());
        return stress;
    }
    with_shape(mesh.cell_start[found + 1] - mesh.cell_start[found], [&](auto shape) {
        using Shape = decltype(shape);
        typename Shape::Natural at{};
        std::copy_n(place.natural.begin(), Shape::dimension, at.begin());
        sample_points<Shape>(rows, 4, at, stress);
    });
    return stress;
}

FreePoints make_free_points(const Scene& scene, const Mesh& mesh, const Points& mesh_points, const Walls& walls) {
    std::vector<double> density;
    for (const Soil& soil : scene.soils) density.push_back(soil.dry_density);
    const double corner = walls.left.kind != WallKind::none ? walls.left.place : walls.right.place;
    SeededPoints seeded = seed_points(mesh, find_cell_size(scene, walls), {corner, walls.base.place}, density);
    if (scene.initial.stress == InitialStress::zero) return std::move(seeded.points);
    const Locator locator(mesh);
    for (size_t p = 0; p < seeded.points.count; ++p) {
        const CellPlace place = locator.locate(seeded.points[position_x][p], seeded.points[position_y][p]);
        const std::array<double, 4> stress = stress_at(mesh, mesh_points, place, seeded.cell[p]);
        for (const size_t k : {0, 1, 2, 3}) seeded.points.field[stress_xx + k][p] = stress[k];
    }
    return std::move(seeded.points);
}

ExplicitMotion make_motion(const Scene& scene, const Mesh& mesh, const Points& mesh_points, int32_t threads) {
    const Walls walls = find_walls(scene, mesh);
    return {find_cell_size(scene, walls),
            walls,
            scene.gravity,
            explicit_soils(scene),
            make_free_points(scene, mesh, mesh_points, walls),
            threads};
}

double sum(const Energies& energies) { return energies.kinetic + energies.elastic + energies.potential; }

double largest_speed(const FreePoints& points) {
    double largest = 0;
    for (size_t p = 0; p < points.count; ++p)
        largest = std::max(largest, std::hypot(points[velocity_x][p], points[velocity_y][p]));
    return largest;
}

/// Whether all of a field are numbers: the sum of finite values is one, below what ground can have.
bool is_finite(const FreePoints& points, PointField name) {
    double total = 0;
    for (size_t p = 0; p < points.count; ++p) total += points[name][p];
    return std::isfinite(total);
}

[[noreturn]] void stop(double time, const std::string& problem) {
    throw Error(Status::not_converged,
                "t = " + value_text(time) + " s: " + problem + "; this says nothing about the slope");
}

}  // namespace

DynamicGround::DynamicGround(const Scene& scene, const Mesh& mesh, const Points& mesh_points, int32_t threads)
    : soils_(explicit_soils(scene)),
      motion_(make_motion(scene, mesh, mesh_points, threads)),
      start_energy_(sum(motion_.energies())) {
    for (const Soil& soil : scene.soils) grain_density_.push_back(soil.dry_density / (1 - soil.porosity));
    const FreePoints& points = motion_.points();
    start_position_.resize(2 * points.count);
    for (size_t p = 0; p < points.count; ++p) {
        const auto number = static_cast<size_t>(points.number[p]);
        start_position_[2 * number] = points[position_x][p];
        start_position_[2 * number + 1] = points[position_y][p];
    }
}

// The macro step of a dynamic ground: substeps of equal length, as long as the fastest wave and the fastest motion allow.
bool DynamicGround::advance(double from, double until, const Cancelled& cancelled) {
    motion_.restart();  // what follows depends on the points alone
    substeps_ = 0;
    peak_velocity_ = 0;
    double time = from;
    while (time < until) {
        const double left = until - time;
        const double count = std::ceil(left / motion_.critical_step());
        const bool is_last = count <= 1;
        const double next = is_last ? until : time + left / count;
        if (!(next > time)) stop(time, "the motion became too fast to be followed");
        const bool looks = is_last || substeps_ % substeps_a_look == substeps_a_look - 1;
        if (!motion_.step(next - time, looks))
            stop(next, "ground moved across several cells in a substep, or its velocity came to no number");
        ++substeps_;
        time = next;
        if (!looks) continue;
        look(time);
        if (cancelled((time - from) / (until - from))) return false;
    }
    return true;
}

void DynamicGround::look(double time) {
    const FreePoints& points = motion_.points();
    for (const PointField name :
         {position_x, position_y, velocity_x, velocity_y, stress_xx, stress_yy, stress_zz, stress_xy, point_volume}) {
        if (!is_finite(points, name)) stop(time, "the state of the ground came to no number");
    }
    check_pores(time);
    if (static_cast<double>(motion_.grid().nodes()) > most_nodes)
        stop(time, "the ground spread over more than " + value_text(most_nodes) + " cells");
    peak_velocity_ = std::max(peak_velocity_, largest_speed(points));
}

/// Grains keep their volume: no ground is denser than they are.
void DynamicGround::check_pores(double time) const {
    const FreePoints& points = motion_.points();
    for (size_t p = 0; p < points.count; ++p) {
        const double grains = grain_density_[static_cast<size_t>(points.soil[p])] * points[point_volume][p];
        if (points[solid_mass][p] <= grains) continue;
        stop(time, "at (" + value_text(points[position_x][p]) + ", " + value_text(points[position_y][p]) +
                       ") m the ground is pressed to less than the volume of its grains, too soft for what it bears");
    }
}

MotionReport DynamicGround::report() const {
    const FreePoints& points = motion_.points();
    MotionReport report;
    report.substeps = substeps_;
    const Energies energies = motion_.energies();
    report.kinetic_energy = energies.kinetic;
    report.elastic_energy = energies.elastic;
    report.potential_energy = energies.potential;
    report.dissipated_energy = start_energy_ - sum(energies);
    report.largest_velocity = largest_speed(points);
    report.peak_velocity = std::max(peak_velocity_, report.largest_velocity);
    double advance = 0;  // m3 m: of the sliding volume along x
    std::vector<size_t> sliding;
    for (size_t p = 0; p < points.count; ++p) {
        const double* start = &start_position_[2 * static_cast<size_t>(points.number[p])];
        const double along = points[position_x][p] - start[0];
        const double displacement = std::hypot(along, points[position_y][p] - start[1]);
        report.largest_displacement = std::max(report.largest_displacement, displacement);
        if (displacement <= cell_size()) continue;
        sliding.push_back(p);
        report.sliding_volume += points[point_volume][p];
        advance += points[point_volume][p] * along;
    }
    if (sliding.empty()) return report;
    const double forwards = advance < 0 ? -1 : 1;
    double front = -std::numeric_limits<double>::infinity(), start_front = front;
    for (const size_t p : sliding) {
        front = std::max(front, forwards * points[position_x][p]);
        start_front = std::max(start_front, forwards * start_position_[2 * static_cast<size_t>(points.number[p])]);
    }
    report.front_x = forwards * front;
    report.run_out = front - start_front;
    return report;
}

std::vector<double> DynamicGround::mobilised_strength() const {
    const FreePoints& points = motion_.points();
    std::vector<double> mobilised(points.count, 0.0);
    MaterialBlock block;
    for (size_t first = 0; first < points.count; first += block_size) {
        const size_t count = std::min(block_size, points.count - first);
        set_strength(soils_, points, first, count, cell_size(), block);
        for (size_t k = 0; k < count; ++k) {
            const size_t p = first + k;
            if (!soils_[static_cast<size_t>(points.soil[p])].yields) continue;
            const MohrCoulomb material{block.cohesion[k], block.sin_friction[k], block.cos_friction[k],
                                       block.sin_dilation[k], block.tensile_strength[k]};
            mobilised[static_cast<size_t>(points.number[p])] = talus::mobilised_strength(
                material, {points[stress_xx][p], points[stress_yy][p], points[stress_zz][p], points[stress_xy][p]});
        }
    }
    return mobilised;
}

}  // namespace talus

// Patch test and manufactured solutions of the flow on distorted meshes.
#pragma once

#include "flow/integrator.hpp"
#include "verification/distorted.hpp"

#include <limits>
#include <numbers>

namespace talus::test {

inline constexpr double unit_weight = 9810;  // Pa/m, of water
using Field = std::function<double(double, double)>;

/// A rigid ground of one soil that is Gardner's where it is dry: S_e = k_r = exp(-alpha s), alpha in 1/Pa.
inline Scene gardner_scene(double alpha, const Conductivity& conductivity) {
    Scene scene;
    scene.physics.deforming = false;
    Soil soil;
    soil.porosity = 0.4;
    soil.hydraulics.retention.model = RetentionModel::gardner;
    soil.hydraulics.retention.alpha = alpha;
    soil.hydraulics.relative_permeability.model = PermeabilityModel::gardner;
    soil.hydraulics.relative_permeability.alpha = alpha;
    soil.hydraulics.conductivity = conductivity;
    scene.soils.push_back(soil);
    return scene;
}

inline FlowSystem make_flow(const Scene& scene, const Mesh& mesh, const FlowBoundaries& boundaries) {
    FlowSystem system(scene, mesh.node_count(), make_network(mesh, scene), boundaries);
    system.skeleton.pore_volume.assign(system.network.portions.size(), {});
    for (size_t corner = 0; corner < system.network.corner_portion.size(); ++corner) {
        system.skeleton.pore_volume[static_cast<size_t>(system.network.corner_portion[corner])].start +=
            scene.soils[0].porosity * system.network.corner_volume[corner];
    }
    return system;
}

/// Nodal pressures of the steady state of a rectangle on whose edge the pressure is `exact`; empty where none was found.
inline std::vector<double> steady_pressure(const Scene& scene, const Mesh& mesh, const Field& exact, double width,
                                           double height) {
    FlowBoundaries boundaries;
    std::vector<Ramp> held;
    double mean = 0;
    for (int32_t node = 0; node < mesh.node_count(); ++node) {
        const double x = mesh.position[2 * static_cast<size_t>(node)],
                     y = mesh.position[2 * static_cast<size_t>(node) + 1];
        if (!is_on_edge(x, y, width, height)) continue;
        boundaries.held.push_back({node, -1});
        held.push_back({exact(x, y), 0});
        mean += exact(x, y);
    }
    FlowSystem system = make_flow(scene, mesh, boundaries);
    system.forcing.held = held;
    FlowIntegrator integrator(system, scene.numerics.tolerance);
    FlowState state;
    state.pressure.assign(static_cast<size_t>(mesh.node_count()), mean / static_cast<double>(held.size()));
    if (!integrator.find_steady(state)) return {};
    return state.pressure;
}

/// Largest error of the pressure over the largest pressure, under a head linear in x and y in saturated ground whose bedding dips.
inline double flow_patch_error(CellKind kind) {
    constexpr double width = 2, height = 1.5;
    const Mesh mesh = distorted_mesh(5, 4, kind, width, height);
    const Field exact = [](double x, double y) { return unit_weight * (10 + 2 * x - 3 * y - y); };
    const std::vector<double> pressure =
        steady_pressure(gardner_scene(1e-3, {1e-5, 2e-6, 25}), mesh, exact, width, height);
    double error = pressure.empty() ? std::numeric_limits<double>::infinity() : 0;
    for (size_t i = 0; i < pressure.size(); ++i) {
        const double right = exact(mesh.position[2 * i], mesh.position[2 * i + 1]);
        error = std::max(error, std::abs(pressure[i] - right) / exact(width, 0));
    }
    return error;
}

/// Saturated: the head 10 + e^x cos y, which is harmonic.
inline double saturated_pressure(double x, double y) { return unit_weight * (10 + std::exp(x) * std::cos(y) - y); }

/// Gardner's soil with 1/alpha = 0.5 m of water: k_r = exp(alpha p) solves laplace(k) + a dk/dy = 0, a = alpha rho g = 2 / m, which is
/// linear: a flow by gravity alone, one that decays upwards and one that varies along x.
inline double gardner_pressure(double x, double y) {
    constexpr double pi = std::numbers::pi, a = 2;
    const double decay = a / 2 + std::sqrt(pi * pi + a * a / 4);
    const double k = 0.4 + 0.3 * std::exp(-a * y) + 0.2 * std::cos(pi * x) * std::exp(-decay * y);
    return unit_weight * std::log(k) / a;
}

/// L2 error of the steady pressure over its norm, on cells x cells of the unit square; infinite where no steady state was found.
inline double steady_error(CellKind kind, int32_t cells, const Field& exact) {
    const Mesh mesh = distorted_mesh(cells, cells, kind);
    const std::vector<double> pressure =
        steady_pressure(gardner_scene(2 / unit_weight, {1e-5, 1e-5, 0}), mesh, exact, 1, 1);
    if (pressure.empty()) return std::numeric_limits<double>::infinity();
    return relative_error(mesh, make_points(mesh), pressure, 1,
                          [&](double x, double y, size_t) { return exact(x, y); });
}

/// Nodal pressures after an hour in `steps` steps of the same length, of a closed column of Gardner's soil that starts with a wet middle.
inline std::vector<double> redistributed_pressure(int32_t steps) {
    constexpr double duration = 3600, no_control = 1e9;
    const Scene scene = gardner_scene(2 / unit_weight, {1e-5, 1e-5, 0});
    const Mesh mesh = column_mesh(20, 1);
    FlowSystem system = make_flow(scene, mesh, {});
    FlowIntegrator integrator(system, no_control);
    FlowState state;
    for (const double y : mesh.position)
        state.pressure.push_back(-unit_weight * (1 + y + 0.5 * std::cos(2 * std::numbers::pi * y)));
    system.evaluate(0, state.pressure);
    state.stored.assign(system.stored().begin(), system.stored().end());
    const double step = duration / steps;
    for (int32_t i = 0; i < steps; ++i) {
        state.substep = step;
        if (integrator.advance(state, step, [](double, std::span<const double>) { return false; }) !=
            AdvanceResult::done)
            return {};
    }
    if (integrator.statistics().substeps != steps) return {};
    return state.pressure;
}

/// Largest error in time of the redistributed pressure against a hundred times smaller steps; infinite where a step failed.
inline double redistribution_error(int32_t steps) {
    const std::vector<double> found = redistributed_pressure(steps), reference = redistributed_pressure(100 * steps);
    double error = found.empty() || reference.empty() ? std::numeric_limits<double>::infinity() : 0;
    for (size_t i = 0; i < std::min(found.size(), reference.size()); ++i)
        error = std::max(error, std::abs(found[i] - reference[i]));
    return error;
}

}  // namespace talus::test

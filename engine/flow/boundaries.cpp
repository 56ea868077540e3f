#include "flow/boundaries.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace talus {
namespace {

struct FacetGeometry {
    double middle_x, middle_y;
    double area;        ///< m2 per metre of thickness
    double horizontal;  ///< area times the upward component of the outward normal, m2
};

FacetGeometry facet_geometry(const Mesh& mesh, const Facet& facet) {
    if (mesh.dimension == 1) {
        const double y = mesh.position[static_cast<size_t>(facet.node_a)];
        return {0.0, y, 1.0, mesh.sides[static_cast<size_t>(facet.side)] == "surface" ? 1.0 : -1.0};
    }
    const double* a = &mesh.position[2 * static_cast<size_t>(facet.node_a)];
    const double* b = &mesh.position[2 * static_cast<size_t>(facet.node_b)];
    return {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), std::hypot(b[0] - a[0], b[1] - a[1]), a[0] - b[0]};
}

Place node_place(const Mesh& mesh, int32_t node) {
    const auto index = static_cast<size_t>(node);
    if (mesh.dimension == 1) return {0.0, mesh.position[index]};
    return {mesh.position[2 * index], mesh.position[2 * index + 1]};
}

bool contains(const Boundary& boundary, double x, double y) {
    return x >= boundary.x_from && x <= boundary.x_to && y >= boundary.y_from && y <= boundary.y_to;
}

/// The last boundary that speaks of the flow through a facet; -1: none.
int32_t flow_boundary(const Scene& scene, const Mesh& reference, const Facet& facet) {
    for (auto b = static_cast<int32_t>(scene.boundaries.size()) - 1; b >= 0; --b) {
        const Boundary& boundary = scene.boundaries[static_cast<size_t>(b)];
        if (boundary.has_flow && covers(boundary, reference, facet)) return b;
    }
    return -1;
}

bool takes_rain(const Scene& scene, const Mesh& reference, const Facet& facet, int32_t boundary) {
    if (boundary >= 0) return scene.boundaries[static_cast<size_t>(boundary)].flow == FlowCondition::surface;
    return reference.sides[static_cast<size_t>(facet.side)] == "surface";
}

template <class Visit>
void each_facet_node(const Facet& facet, Visit visit) {
    if (facet.node_b < 0) {
        visit(facet.node_a, 1.0);
    } else {
        visit(facet.node_a, 0.5);
        visit(facet.node_b, 0.5);
    }
}

double largest_conductivity(const Scene& scene, const Mesh& mesh, int32_t cell) {
    const auto soil = static_cast<size_t>(mesh.cell_soil[static_cast<size_t>(cell)]);
    const Conductivity& k = scene.soils[soil].hydraulics.conductivity;
    return std::max(k.along, k.across);
}

class Builder {
public:
    Builder(const Mesh& mesh, const Mesh& reference, const Scene& scene)
        : mesh_(mesh), reference_(reference), scene_(scene) {}

    FlowBoundaries build() {
        for (size_t f = 0; f < mesh_.facets.size(); ++f) {
            const Facet& facet = mesh_.facets[f];
            const int32_t boundary = flow_boundary(scene_, reference_, facet);
            if (takes_rain(scene_, reference_, facet, boundary)) {
                add_surface(facet);
                result_.surface_facets.push_back(static_cast<int32_t>(f));
            }
            if (boundary < 0) continue;
            const FlowCondition condition = scene_.boundaries[static_cast<size_t>(boundary)].flow;
            if (condition == FlowCondition::flux) add_flux(facet, boundary);
        }
        for (size_t b = 0; b < scene_.boundaries.size(); ++b) add_held(static_cast<int32_t>(b));
        for (const auto& [node, boundary] : held_) result_.held.push_back({node, boundary});
        return std::move(result_);
    }

private:
    int32_t surface_index(int32_t node) {
        const auto [found, added] = surface_.try_emplace(node, static_cast<int32_t>(result_.surface.size()));
        if (added) result_.surface.push_back({node});
        return found->second;
    }

    void add_surface(const Facet& facet) {
        const FacetGeometry geometry = facet_geometry(mesh_, facet);
        const FacetGeometry origin = facet_geometry(reference_, facet);
        each_facet_node(facet, [&](int32_t node, double share) {
            const int32_t index = surface_index(node);
            SurfaceNode& here = result_.surface[static_cast<size_t>(index)];
            here.area += share * geometry.area;
            here.pond_area += share * origin.area;
            here.rain_area += share * std::max(0.0, geometry.horizontal);
            here.conductivity = std::max(here.conductivity, largest_conductivity(scene_, mesh_, facet.cell));
            for (size_t zone = 0; zone < scene_.surface.zones.size(); ++zone) {
                const RainZone& rain = scene_.surface.zones[zone];
                if (origin.middle_x < rain.x_from || origin.middle_x > rain.x_to) continue;
                result_.zone_shares.push_back(
                    {index, static_cast<int32_t>(zone), share * std::max(0.0, geometry.horizontal)});
            }
        });
    }

    void add_flux(const Facet& facet, int32_t boundary) {
        const double area = facet_geometry(mesh_, facet).area;
        each_facet_node(facet, [&](int32_t node, double share) {
            result_.flux_shares.push_back({node, boundary, share * area});
        });
    }

    // Nodes, not facets, so that a water table between two nodes holds nothing above itself.
    void add_held(int32_t number) {
        const Boundary& boundary = scene_.boundaries[static_cast<size_t>(number)];
        if (!boundary.has_flow) return;
        if (boundary.flow != FlowCondition::pressure && boundary.flow != FlowCondition::hydrostatic) return;
        for (const Facet& facet : reference_.facets) {
            if (reference_.sides[static_cast<size_t>(facet.side)] != boundary.side) continue;
            each_facet_node(facet, [&](int32_t node, double) {
                const auto [x, y] = node_place(reference_, node);
                if (contains(boundary, x, y)) held_[node] = number;
            });
        }
    }

    const Mesh& mesh_;
    const Mesh& reference_;
    const Scene& scene_;
    FlowBoundaries result_;
    std::map<int32_t, int32_t> surface_;
    std::map<int32_t, int32_t> held_;
};

}  // namespace

FlowBoundaries make_flow_boundaries(const Mesh& mesh, const Mesh& reference, const Scene& scene) {
    return Builder(mesh, reference, scene).build();
}

bool covers(const Boundary& boundary, const Mesh& mesh, const Facet& facet) {
    if (mesh.sides[static_cast<size_t>(facet.side)] != boundary.side) return false;
    const FacetGeometry at = facet_geometry(mesh, facet);
    return contains(boundary, at.middle_x, at.middle_y);
}

double value_at(const Series& series, double time) {
    if (series.value.empty()) return 0.0;
    if (time <= series.time.front()) return series.value.front();
    if (time >= series.time.back()) return series.value.back();
    const auto after =
        static_cast<size_t>(std::upper_bound(series.time.begin(), series.time.end(), time) - series.time.begin());
    const double share = (time - series.time[after - 1]) / (series.time[after] - series.time[after - 1]);
    return series.value[after - 1] + share * (series.value[after] - series.value[after - 1]);
}

}  // namespace talus

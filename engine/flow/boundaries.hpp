// Where water crosses the edge of the ground: the rained-on surface, held pressures and given fluxes.
//
// The surface is one complementarity without modes. Its nodes take all rain; water above the ground (p > 0) is stored as a pond up to
// the depth allowed, and what stands higher leaves over a weir so wide that it is a fraction of a pascal high. Rain that the ground does
// not take and water that seeps out are the same term; the first is what stays within the node's own rain.
#pragma once

#include "ground/mesh.hpp"
#include "scene/scene.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace talus {

struct SurfaceNode {
    int32_t node;
    double area = 0;          ///< of the surface, m2 (per metre of thickness)
    double pond_area = 0;     ///< the same at the start: a pond whose floor moves neither gains nor loses water
    double rain_area = 0;     ///< its horizontal projection, where it faces up, m2
    double conductivity = 0;  ///< largest saturated conductivity at the node, m/s: scale of the weir
};

/// The horizontal area through which one rain zone feeds one surface node.
struct ZoneShare {
    int32_t surface_node;  ///< index into FlowBoundaries::surface
    int32_t zone;
    double area;  ///< m2
};

/// A node whose pressure a boundary holds.
struct HeldNode {
    int32_t node;
    int32_t boundary;  ///< index into Scene::boundaries
};

/// The area through which a boundary's flux feeds a node.
struct FluxShare {
    int32_t node;
    int32_t boundary;
    double area;  ///< m2
};

struct FlowBoundaries {
    std::vector<SurfaceNode> surface;
    std::vector<int32_t> surface_facets;  ///< indices into Mesh::facets: where those nodes are
    std::vector<ZoneShare> zone_shares;
    std::vector<HeldNode> held;
    std::vector<FluxShare> flux_shares;
};

/// Of the mesh as it lies now. The choice of nodes follows `reference`, the mesh at the start, so that it never changes.
FlowBoundaries make_flow_boundaries(const Mesh& mesh, const Mesh& reference, const Scene& scene);

/// Whether a facet's middle lies on the part of a side that a boundary names.
bool covers(const Boundary& boundary, const Mesh& mesh, const Facet& facet);

/// Value of a series at a time: linear between its times, constant outside.
double value_at(const Series& series, double time);

}  // namespace talus

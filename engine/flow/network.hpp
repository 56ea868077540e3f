// The flow's discretisation: nodes, the portions of pore space of each soil around them, and the links between portions.
//
// Mass-lumped linear finite elements on the fitted mesh with quadrature at the cells' corners. At a corner the edges to the next and the
// previous corner, with dual vectors g1, g2, span the gradient of the head, and with one mean k_r an edge the power lost there is
//     w (g1.K g1 k1 d1^2 + 2 g1.K g2 sqrt(k1 k2) d1 d2 + g2.K g2 k2 d2^2),    d: head lost along the edge,
// never negative whatever the cell's shape, K and k_r, so that a steady state always exists. Its derivatives by d1 and d2 are the flows along
// the two edges: a link's own transmissibility is positive, and crossings make the flow along one link follow the head along another where
// the cell is not rectangular. Water is conserved by construction: what leaves one portion through a link enters the other.
// See docs/theory.md.
#pragma once

#include "ground/mesh.hpp"
#include "scene/scene.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace talus {

/// The pore space of one soil around one node.
struct Portion {
    int32_t node;
    int32_t soil;
};

/// Two portions of the same soil: the ends of an edge of a cell.
struct Link {
    int32_t portion_a;
    int32_t portion_b;
};

/// Two links that meet at a corner of a cell under an angle.
struct Crossing {
    int32_t link_a;
    int32_t link_b;
};

struct Network {
    std::vector<Portion> portions;
    std::vector<Link> links;
    std::vector<Crossing> crossings;
    std::vector<Link> neighbours;          ///< portions that share a cell, the pressure projection's; empty: rigid
    std::vector<int32_t> corner_portion;   ///< like Mesh::cell_nodes: the portion that each cell's corner belongs to
    std::vector<int32_t> corner_link;      ///< likewise: the link from the corner to the next one of the cell; -1: none
    std::vector<int32_t> corner_crossing;  ///< likewise: the crossing of the two links that meet there; -1: none
    std::vector<int32_t> pair_start;       ///< cells + 1 offsets into pair_neighbours; empty: rigid
    std::vector<int32_t>
        pair_neighbours;  ///< the neighbours of each pair (i < j) of a cell's corners, in lexicographic order

    // Geometry, refreshed when the ground moves
    std::vector<double>
        corner_volume;  ///< like corner_portion: m3 of ground (per metre of thickness, or per m2 in a column)
    std::vector<double> transmissibility;  ///< per link, m3/(s Pa)
    std::vector<double> fall;              ///< per link, Pa: weight of a water column as high as a lies above b
    std::vector<double>
        cross_transmissibility;  ///< per crossing, flow a -> b of one link per head lost along the other, m3/(s Pa)
};

/// A symmetric tensor in the plane.
struct Tensor {
    double xx, xy, yy;
};

/// Saturated hydraulic conductivity along x and y, m/s.
Tensor conductivity_tensor(const Conductivity& conductivity);

/// Portions and links of a mesh with their geometry. Rectangles get no crossings when the skeleton is rigid: there they can have none later.
Network make_network(const Mesh& mesh, const Scene& scene);

/// Fills the geometry from the mesh as it lies now. conductivity_factor: per cell, K now / K given; empty: 1.
void refresh_geometry(Network& network, const Mesh& mesh, const Scene& scene,
                      std::span<const double> conductivity_factor);

}  // namespace talus

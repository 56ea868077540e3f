// The flow's discretisation: nodes, the portions of pore space of each soil around them, and the links between portions.
//
// Mass-lumped linear finite elements on the fitted mesh, written as a network: a cell of conductivity K gives its corners i, j a link of
// transmissibility T_ij = -integral(grad N_i . K grad N_j)/(rho g), with quadrature at the cell's corners. On right-angled quads this is
// the five-point finite volume scheme with positive T; on any quad and triangle it is exact for a linear head. Water is conserved by
// construction: what leaves one portion through a link enters the other. See docs/theory.md.
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

/// A path for water between two portions of the same soil.
struct Link {
    int32_t portion_a;
    int32_t portion_b;
};

struct Network {
    std::vector<Portion> portions;
    std::vector<Link> links;
    std::vector<int32_t> corner_portion;  ///< like Mesh::cell_nodes: the portion that each cell's corner belongs to
    std::vector<int32_t> pair_start;      ///< cells + 1 offsets into pair_link
    std::vector<int32_t>
        pair_link;  ///< the link of each pair (i < j) of a cell's corners, in lexicographic order; -1: none

    // Geometry, refreshed when the ground moves
    std::vector<double>
        corner_volume;  ///< like corner_portion: m3 of ground (per metre of thickness, or per m2 in a column)
    std::vector<double> transmissibility;  ///< per link, m3/(s Pa)
    std::vector<double> fall;              ///< per link, flow a -> b under gravity alone at k_r = 1, m3/s
    std::vector<double>
        joined_volume;  ///< per link, sum over its cells of volume / corners^2, m3: weight of the pressure projection
};

/// A symmetric tensor in the plane.
struct Tensor {
    double xx, xy, yy;
};

/// Saturated hydraulic conductivity along x and y, m/s.
Tensor conductivity_tensor(const Conductivity& conductivity);

/// Portions and links of a mesh with their geometry. Pairs that conduct nothing (the diagonals of rectangles) get no link when the
/// skeleton is rigid: there they can neither conduct later nor need the pressure projection.
Network make_network(const Mesh& mesh, const Scene& scene);

/// Fills the geometry from the mesh as it lies now. conductivity_factor: per cell, K now / K given; empty: 1.
void refresh_geometry(Network& network, const Mesh& mesh, const Scene& scene,
                      std::span<const double> conductivity_factor);

}  // namespace talus

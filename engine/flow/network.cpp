#include "flow/network.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace talus {
namespace {

using Vector = std::array<double, 2>;

double contract(const Vector& a, const Tensor& k, const Vector& b) {
    return a[0] * (k.xx * b[0] + k.xy * b[1]) + a[1] * (k.xy * b[0] + k.yy * b[1]);
}

struct CellGeometry {
    int corners = 0;
    double volume = 0;
    std::array<double, 4> corner_volume{};
    std::array<double, 4>
        conductance{};  ///< per edge (c, c + 1), integral of grad . K grad of its dual vector, m2/s (a column: m/s)
    std::array<double, 4>
        crossing{};  ///< per corner, the same of the two dual vectors there, for head lost away from the corner
};

CellGeometry line_geometry(const Mesh& mesh, const int32_t* nodes, const Tensor& k) {
    const double length =
        std::abs(mesh.position[static_cast<size_t>(nodes[1])] - mesh.position[static_cast<size_t>(nodes[0])]);
    return {2, length, {0.5 * length, 0.5 * length}, {k.yy / length}, {}};
}

// Quadrature at corner c, whose edges to the next and the previous corner span the local frame.
void add_corner(CellGeometry& cell, int c, const Vector& to_next, const Vector& to_previous, double share,
                const Tensor& k) {
    const double det = to_next[0] * to_previous[1] - to_next[1] * to_previous[0];
    const Vector dual_next{to_previous[1] / det, -to_previous[0] / det};
    const Vector dual_previous{-to_next[1] / det, to_next[0] / det};
    const double weight = share * det;
    cell.conductance[static_cast<size_t>(c)] += weight * contract(dual_next, k, dual_next);
    cell.conductance[static_cast<size_t>((c + cell.corners - 1) % cell.corners)] +=
        weight * contract(dual_previous, k, dual_previous);
    cell.crossing[static_cast<size_t>(c)] = weight * contract(dual_next, k, dual_previous);
}

CellGeometry plane_geometry(const Mesh& mesh, const int32_t* nodes, int corners, const Tensor& k) {
    const auto at = [&](int c) {
        const auto node = static_cast<size_t>(nodes[c % corners]);
        return Vector{mesh.position[2 * node], mesh.position[2 * node + 1]};
    };
    const auto edge = [&](int from, int to) {
        const Vector a = at(from);
        const Vector b = at(to);
        return Vector{b[0] - a[0], b[1] - a[1]};
    };
    CellGeometry cell;
    cell.corners = corners;
    if (corners == 3) {
        const Vector a = edge(0, 1);
        const Vector b = edge(0, 2);
        cell.volume = 0.5 * (a[0] * b[1] - a[1] * b[0]);
        cell.corner_volume.fill(cell.volume / 3.0);
        for (int c = 0; c < 3; ++c) add_corner(cell, c, edge(c, c + 1), edge(c, c + 2), 0.5 / 3.0, k);
        return cell;
    }
    // The Jacobian determinant is linear over the quad, hence integral(N_i det) = sum_c det_c {1/9, 1/18, 1/36} by how far c lies from i.
    for (int c = 0; c < 4; ++c) {
        const Vector next = edge(c, c + 1);
        const Vector previous = edge(c, c + 3);
        const double det = next[0] * previous[1] - next[1] * previous[0];
        cell.volume += 0.25 * det;
        cell.corner_volume[static_cast<size_t>(c)] += det / 9.0;
        cell.corner_volume[static_cast<size_t>((c + 1) % 4)] += det / 18.0;
        cell.corner_volume[static_cast<size_t>((c + 3) % 4)] += det / 18.0;
        cell.corner_volume[static_cast<size_t>((c + 2) % 4)] += det / 36.0;
        add_corner(cell, c, next, previous, 0.25, k);
    }
    return cell;
}

CellGeometry cell_geometry(const Mesh& mesh, int32_t cell, const Tensor& k) {
    const int32_t first = mesh.cell_start[static_cast<size_t>(cell)];
    const int corners = mesh.cell_start[static_cast<size_t>(cell) + 1] - first;
    const int32_t* nodes = mesh.cell_nodes.data() + first;
    return corners == 2 ? line_geometry(mesh, nodes, k) : plane_geometry(mesh, nodes, corners, k);
}

void make_portions(Network& network, const Mesh& mesh) {
    std::map<std::pair<int32_t, int32_t>, int32_t> numbers;  // (node, soil): in the order of the nodes
    const auto each_corner = [&](auto&& visit) {
        for (int32_t cell = 0; cell < mesh.cell_count(); ++cell) {
            const int32_t soil = mesh.cell_soil[static_cast<size_t>(cell)];
            for (int32_t c = mesh.cell_start[static_cast<size_t>(cell)];
                 c < mesh.cell_start[static_cast<size_t>(cell) + 1]; ++c)
                visit(static_cast<size_t>(c), std::pair{mesh.cell_nodes[static_cast<size_t>(c)], soil});
        }
    };
    each_corner([&](size_t, const auto& key) { numbers.emplace(key, 0); });
    for (auto& [key, number] : numbers) {
        number = static_cast<int32_t>(network.portions.size());
        network.portions.push_back({key.first, key.second});
    }
    network.corner_portion.resize(mesh.cell_nodes.size());
    each_corner([&](size_t corner, const auto& key) { network.corner_portion[corner] = numbers.at(key); });
}

// The numbers of pairs of portions, in the order in which they come.
class PairNumbers {
public:
    explicit PairNumbers(std::vector<Link>& pairs) : pairs_(pairs) {}

    int32_t of(int32_t a, int32_t b) {
        const auto [found, added] = numbers_.try_emplace(std::minmax(a, b), static_cast<int32_t>(pairs_.size()));
        if (added) pairs_.push_back({found->first.first, found->first.second});
        return found->second;
    }

private:
    std::vector<Link>& pairs_;
    std::map<std::pair<int32_t, int32_t>, int32_t> numbers_;
};

size_t cell_corners(const Mesh& mesh, int32_t cell) {
    return static_cast<size_t>(mesh.cell_start[static_cast<size_t>(cell) + 1] -
                               mesh.cell_start[static_cast<size_t>(cell)]);
}

void make_links(Network& network, const Mesh& mesh) {
    PairNumbers numbers(network.links);
    network.corner_link.assign(network.corner_portion.size(), -1);
    for (int32_t cell = 0; cell < mesh.cell_count(); ++cell) {
        const auto first = static_cast<size_t>(mesh.cell_start[static_cast<size_t>(cell)]);
        const size_t corners = cell_corners(mesh, cell);
        for (size_t c = 0; c < (corners == 2 ? 1 : corners); ++c) {
            network.corner_link[first + c] =
                numbers.of(network.corner_portion[first + c], network.corner_portion[first + (c + 1) % corners]);
        }
    }
}

void make_crossings(Network& network, const Mesh& mesh, const Scene& scene) {
    constexpr double right_angle = 1e-12;  // a crossing below this share of the cell's conductance is none
    network.corner_crossing.assign(network.corner_portion.size(), -1);
    for (int32_t cell = 0; cell < mesh.cell_count(); ++cell) {
        const auto first = static_cast<size_t>(mesh.cell_start[static_cast<size_t>(cell)]);
        const size_t corners = cell_corners(mesh, cell);
        if (corners == 2) continue;
        const CellGeometry geometry = cell_geometry(mesh, cell, {1, 0, 1});
        const double largest = *std::max_element(geometry.conductance.begin(), geometry.conductance.end());
        const Conductivity& k =
            scene.soils[static_cast<size_t>(mesh.cell_soil[static_cast<size_t>(cell)])].hydraulics.conductivity;
        const bool all_corners = scene.physics.deforming || k.along != k.across;
        for (size_t c = 0; c < corners; ++c) {
            if (!all_corners && std::abs(geometry.crossing[c]) < right_angle * largest) continue;
            network.corner_crossing[first + c] = static_cast<int32_t>(network.crossings.size());
            network.crossings.push_back(
                {network.corner_link[first + c], network.corner_link[first + (c + corners - 1) % corners]});
        }
    }
}

void make_neighbours(Network& network, const Mesh& mesh) {
    PairNumbers numbers(network.neighbours);
    network.pair_start.assign(1, 0);
    for (int32_t cell = 0; cell < mesh.cell_count(); ++cell) {
        const auto first = static_cast<size_t>(mesh.cell_start[static_cast<size_t>(cell)]);
        for (size_t i = 0; i < cell_corners(mesh, cell); ++i) {
            for (size_t j = i + 1; j < cell_corners(mesh, cell); ++j) {
                network.pair_neighbours.push_back(
                    numbers.of(network.corner_portion[first + i], network.corner_portion[first + j]));
            }
        }
        network.pair_start.push_back(static_cast<int32_t>(network.pair_neighbours.size()));
    }
}

}  // namespace

Tensor conductivity_tensor(const Conductivity& conductivity) {
    const double angle = conductivity.dip * std::numbers::pi / 180.0;
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    return {conductivity.along * c * c + conductivity.across * s * s,
            (conductivity.along - conductivity.across) * c * s,
            conductivity.along * s * s + conductivity.across * c * c};
}

Network make_network(const Mesh& mesh, const Scene& scene) {
    Network network;
    make_portions(network, mesh);
    make_links(network, mesh);
    make_crossings(network, mesh, scene);
    if (scene.physics.deforming) make_neighbours(network, mesh);
    refresh_geometry(network, mesh, scene, {});
    return network;
}

void refresh_geometry(Network& network, const Mesh& mesh, const Scene& scene,
                      std::span<const double> conductivity_factor) {
    const double unit_weight = scene.water.density * scene.gravity;
    std::vector<Tensor> tensors;
    for (const Soil& soil : scene.soils) tensors.push_back(conductivity_tensor(soil.hydraulics.conductivity));

    network.corner_volume.assign(network.corner_portion.size(), 0.0);
    network.transmissibility.assign(network.links.size(), 0.0);
    network.cross_transmissibility.assign(network.crossings.size(), 0.0);
    for (int32_t cell = 0; cell < mesh.cell_count(); ++cell) {
        const auto index = static_cast<size_t>(cell);
        const CellGeometry geometry = cell_geometry(mesh, cell, tensors[static_cast<size_t>(mesh.cell_soil[index])]);
        const double factor = (conductivity_factor.empty() ? 1.0 : conductivity_factor[index]) / unit_weight;
        const auto first = static_cast<size_t>(mesh.cell_start[index]);
        const auto corners = static_cast<size_t>(geometry.corners);
        for (size_t c = 0; c < corners; ++c) {
            network.corner_volume[first + c] = geometry.corner_volume[c];
            const int32_t link = network.corner_link[first + c];
            if (link >= 0) network.transmissibility[static_cast<size_t>(link)] += factor * geometry.conductance[c];
            const int32_t crossing = network.corner_crossing[first + c];
            if (crossing < 0) continue;
            const Crossing& links = network.crossings[static_cast<size_t>(crossing)];
            const int32_t here = network.corner_portion[first + c];
            const bool away_a = network.links[static_cast<size_t>(links.link_a)].portion_a == here;
            const bool away_b = network.links[static_cast<size_t>(links.link_b)].portion_a == here;
            network.cross_transmissibility[static_cast<size_t>(crossing)] =
                (away_a == away_b ? factor : -factor) * geometry.crossing[c];
        }
    }
    network.fall.resize(network.links.size());
    const auto height = [&](int32_t portion) {
        const auto node = static_cast<size_t>(network.portions[static_cast<size_t>(portion)].node);
        const auto dimension = static_cast<size_t>(mesh.dimension);
        return mesh.position[node * dimension + dimension - 1];
    };
    for (size_t l = 0; l < network.links.size(); ++l)
        network.fall[l] = unit_weight * (height(network.links[l].portion_a) - height(network.links[l].portion_b));
}

}  // namespace talus

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

// Number of the pair (i, j), i != j, among the pairs of `corners` corners in lexicographic order.
constexpr int pair_number(int corners, int i, int j) {
    const int low = std::min(i, j);
    const int high = std::max(i, j);
    return low * corners - low * (low + 1) / 2 + high - low - 1;
}

struct CellGeometry {
    int corners = 0;
    double volume = 0;
    std::array<double, 4> corner_volume{};
    std::array<double, 6> conductance{};  ///< per pair, integral of -grad N_i . K grad N_j, m2/s (a column: m/s)
    std::array<double, 6> fall{};         ///< per pair (i < j), flow i -> j under gravity alone, m2/s (a column: m/s)
};

CellGeometry line_geometry(const Mesh& mesh, const int32_t* nodes, const Tensor& k) {
    const double rise = mesh.position[static_cast<size_t>(nodes[1])] - mesh.position[static_cast<size_t>(nodes[0])];
    const double length = std::abs(rise);
    return {2, length, {0.5 * length, 0.5 * length}, {k.yy / length}, {rise > 0 ? -k.yy : k.yy}};
}

// Quadrature at corner c, whose edges to the next and the previous corner span the local frame: there grad N_next and grad N_prev are the
// frame's dual vectors, grad N_c is minus their sum and the opposite corner has no gradient.
void add_corner(CellGeometry& cell, int c, const Vector& to_next, const Vector& to_previous, double share,
                const Tensor& k) {
    const double det = to_next[0] * to_previous[1] - to_next[1] * to_previous[0];
    const Vector grad_next{to_previous[1] / det, -to_previous[0] / det};
    const Vector grad_previous{-to_next[1] / det, to_next[0] / det};
    const Vector grad_here{-grad_next[0] - grad_previous[0], -grad_next[1] - grad_previous[1]};
    const int next = (c + 1) % cell.corners;
    const int previous = (c + cell.corners - 1) % cell.corners;
    const double weight = share * det;
    const auto pair = [&](int i, int j) { return static_cast<size_t>(pair_number(cell.corners, i, j)); };
    const auto add = [&](int i, int j, double value) { cell.conductance[pair(i, j)] -= weight * value; };
    const auto add_fall = [&](int to, const Vector& gradient) {  // from c, along the edge whose dual vector this is
        const double flow = -weight * (gradient[0] * k.xy + gradient[1] * k.yy);
        cell.fall[pair(c, to)] += c < to ? flow : -flow;
    };
    add_fall(next, grad_next);
    add_fall(previous, grad_previous);
    add(c, next, contract(grad_here, k, grad_next));
    add(c, previous, contract(grad_here, k, grad_previous));
    add(next, previous, contract(grad_next, k, grad_previous));
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

void make_links(Network& network, const Mesh& mesh, const Scene& scene) {
    constexpr double conducts_nothing = 1e-12;  // of the cell's largest conductance
    std::map<std::pair<int32_t, int32_t>, int32_t> numbers;
    network.pair_start.assign(1, 0);
    for (int32_t cell = 0; cell < mesh.cell_count(); ++cell) {
        const auto first = static_cast<size_t>(mesh.cell_start[static_cast<size_t>(cell)]);
        const CellGeometry geometry = cell_geometry(mesh, cell, {1, 0, 1});
        const double largest =
            std::abs(*std::max_element(geometry.conductance.begin(), geometry.conductance.end(),
                                       [](double a, double b) { return std::abs(a) < std::abs(b); }));
        const Conductivity& k =
            scene.soils[static_cast<size_t>(mesh.cell_soil[static_cast<size_t>(cell)])].hydraulics.conductivity;
        const bool all_pairs = scene.physics.deforming || k.along != k.across;
        for (int i = 0; i < geometry.corners; ++i) {
            for (int j = i + 1; j < geometry.corners; ++j) {
                const double conductance =
                    geometry.conductance[static_cast<size_t>(pair_number(geometry.corners, i, j))];
                if (!all_pairs && std::abs(conductance) < conducts_nothing * largest) {
                    network.pair_link.push_back(-1);
                    continue;
                }
                const int32_t a = network.corner_portion[first + static_cast<size_t>(i)];
                const int32_t b = network.corner_portion[first + static_cast<size_t>(j)];
                const auto [found, added] =
                    numbers.try_emplace(std::minmax(a, b), static_cast<int32_t>(network.links.size()));
                if (added) network.links.push_back({found->first.first, found->first.second});
                network.pair_link.push_back(found->second);
            }
        }
        network.pair_start.push_back(static_cast<int32_t>(network.pair_link.size()));
    }
}

}  // namespace

Tensor conductivity_tensor(const Conductivity& conductivity) {
    const double angle = conductivity.dip * std::numbers::pi / 180.0;
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    return {conductivity.along * c * c + conductivity.across * s * s, (conductivity.along - conductivity.across) * c * s,
            conductivity.along * s * s + conductivity.across * c * c};
}

Network make_network(const Mesh& mesh, const Scene& scene) {
    Network network;
    make_portions(network, mesh);
    make_links(network, mesh, scene);
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
    network.joined_volume.assign(network.links.size(), 0.0);
    network.fall.assign(network.links.size(), 0.0);
    for (int32_t cell = 0; cell < mesh.cell_count(); ++cell) {
        const auto index = static_cast<size_t>(cell);
        const CellGeometry geometry = cell_geometry(mesh, cell, tensors[static_cast<size_t>(mesh.cell_soil[index])]);
        const double factor = (conductivity_factor.empty() ? 1.0 : conductivity_factor[index]) / unit_weight;
        const auto first = static_cast<size_t>(mesh.cell_start[index]);
        for (size_t c = 0; c < static_cast<size_t>(geometry.corners); ++c)
            network.corner_volume[first + c] = geometry.corner_volume[c];
        int pair = 0;
        for (int i = 0; i < geometry.corners; ++i) {
            for (int j = i + 1; j < geometry.corners; ++j, ++pair) {
                const int32_t number = network.pair_link[static_cast<size_t>(network.pair_start[index] + pair)];
                if (number < 0) continue;
                const auto link = static_cast<size_t>(number);
                const bool forward = network.corner_portion[first + static_cast<size_t>(i)] == network.links[link].portion_a;
                const double fall = factor * unit_weight * geometry.fall[static_cast<size_t>(pair)];
                network.transmissibility[link] += factor * geometry.conductance[static_cast<size_t>(pair)];
                network.fall[link] += forward ? fall : -fall;
                network.joined_volume[link] += geometry.volume / (geometry.corners * geometry.corners);
            }
        }
    }
}

}  // namespace talus

#include "motion/cell_kinematics.hpp"

#include <algorithm>
#include <map>

namespace talus {

namespace {

int32_t nodes_of(const Mesh& mesh, int32_t cell) {
    return mesh.cell_start[static_cast<size_t>(cell) + 1] - mesh.cell_start[static_cast<size_t>(cell)];
}

const int32_t* cell_nodes(const Mesh& mesh, int32_t cell) {
    return mesh.cell_nodes.data() + mesh.cell_start[static_cast<size_t>(cell)];
}

double cell_volume(const Points& points, int32_t cell) {
    double volume = 0;
    for (int32_t p = points.cell_start[static_cast<size_t>(cell)]; p < points.cell_start[static_cast<size_t>(cell) + 1];
         ++p) {
        volume += points.volume[static_cast<size_t>(p)];
    }
    return volume;
}

std::vector<CellBlock> group_cells(const Mesh& mesh) {
    std::map<std::pair<int32_t, int32_t>, std::vector<int32_t>> groups;  // (nodes, soil) -> cells
    for (int32_t c = 0; c < mesh.cell_count(); ++c) {
        groups[{nodes_of(mesh, c), mesh.cell_soil[static_cast<size_t>(c)]}].push_back(c);
    }
    std::vector<CellBlock> blocks;
    for (auto& [key, cells] : groups) blocks.push_back({key.first, key.second, std::move(cells)});
    return blocks;
}

int32_t slot_in(std::span<const int32_t> nodes, int32_t node) {
    return static_cast<int32_t>(std::find(nodes.begin(), nodes.end(), node) - nodes.begin());
}

}  // namespace

CellKinematics::CellKinematics(const Mesh& mesh, const Points& points) : blocks_(group_cells(mesh)) {
    size_t size = 0;
    for (int32_t c = 0; c < mesh.cell_count(); ++c) {
        gradient_start_.push_back(size);
        const int32_t nodes = nodes_of(mesh, c);
        size += with_shape(nodes, [](auto shape) { return shape.points * shape.nodes * shape.dimension; });
    }
    gradient_.resize(size);
    build_patches(mesh);
    build_stencils(mesh);
    update(mesh, points);
}

void CellKinematics::build_patches(const Mesh& mesh) {
    for (int32_t c = 0; c < mesh.cell_count(); ++c) {
        if (nodes_of(mesh, c) == 3) patches_.triangles.push_back(c);
    }
    std::vector<std::vector<int32_t>> patch(static_cast<size_t>(mesh.node_count()));
    for (const int32_t c : patches_.triangles) {
        const int32_t* const nodes = cell_nodes(mesh, c);
        for (int a = 0; a < 3; ++a) {
            auto& around = patch[static_cast<size_t>(nodes[a])];
            for (int b = 0; b < 3; ++b) {
                if (slot_in(around, nodes[b]) == static_cast<int32_t>(around.size())) around.push_back(nodes[b]);
            }
        }
    }
    patches_.start.push_back(0);
    for (const auto& around : patch) {
        patches_.node.insert(patches_.node.end(), around.begin(), around.end());
        patches_.start.push_back(patches_.node.size());
    }
    for (const int32_t c : patches_.triangles) {
        const int32_t* const nodes = cell_nodes(mesh, c);
        for (int a = 0; a < 3; ++a) {
            for (int b = 0; b < 3; ++b) {
                patches_.corner_slot.push_back(slot_in(patch[static_cast<size_t>(nodes[a])], nodes[b]));
            }
        }
    }
    patches_.dilatation.resize(2 * patches_.node.size());
    patches_.volume.resize(static_cast<size_t>(mesh.node_count()));
}

void CellKinematics::build_stencils(const Mesh& mesh) {
    stencil_start_.push_back(0);
    for (int32_t c = 0; c < mesh.cell_count(); ++c) {
        const int32_t* const nodes = cell_nodes(mesh, c);
        const int32_t count = nodes_of(mesh, c);
        std::vector<int32_t> stencil(nodes, nodes + count);
        if (count == 3) {
            for (int a = 0; a < 3; ++a) {
                const auto node = static_cast<size_t>(nodes[a]);
                for (size_t k = patches_.start[node]; k < patches_.start[node + 1]; ++k) {
                    const int32_t slot = slot_in(stencil, patches_.node[k]);
                    if (slot == static_cast<int32_t>(stencil.size())) stencil.push_back(patches_.node[k]);
                    patches_.stencil_slot.push_back(slot);
                }
            }
        }
        stencil_.insert(stencil_.end(), stencil.begin(), stencil.end());
        stencil_start_.push_back(stencil_.size());
    }
    dilatation_.resize(2 * stencil_.size());
}

void CellKinematics::update(const Mesh& mesh, const Points& points) {
    for_each_block(blocks_, [&](auto shape, const CellBlock& block) {
        update_gradients<decltype(shape)>(mesh, block);
        if constexpr (std::is_same_v<decltype(shape), Quad4>) update_quad_dilatation(points, block);
    });
    if (!patches_.triangles.empty()) update_triangle_dilatation(mesh, points);
}

template <class Shape>
void CellKinematics::update_gradients(const Mesh& mesh, const CellBlock& block) {
    for (const int32_t c : block.cells) {
        const auto places = gather_places<Shape>(mesh.position.data(), cell_nodes(mesh, c));
        for (size_t i = 0; i < Shape::points; ++i) {
            const auto mapped = map_shape<Shape>(places, Shape::point[i]);
            double* out =
                gradient_.data() + gradient_start_[static_cast<size_t>(c)] + i * Shape::nodes * Shape::dimension;
            for (const auto& row : mapped.gradient) out = std::copy(row.begin(), row.end(), out);
        }
    }
}

void CellKinematics::update_quad_dilatation(const Points& points, const CellBlock& block) {
    for (const int32_t c : block.cells) {
        const auto first = static_cast<size_t>(points.cell_start[static_cast<size_t>(c)]);
        const double volume = cell_volume(points, c);
        double* const b = dilatation_.data() + 2 * stencil_start_[static_cast<size_t>(c)];
        std::fill(b, b + 2 * Quad4::nodes, 0.0);
        for (size_t i = 0; i < Quad4::points; ++i) {
            const auto g = gradient<Quad4>(c, i);
            const double share = points.volume[first + i] / volume;
            for (size_t a = 0; a < Quad4::nodes; ++a) {
                b[2 * a] += share * g[a][0];
                b[2 * a + 1] += share * g[a][1];
            }
        }
    }
}

void CellKinematics::update_triangle_dilatation(const Mesh& mesh, const Points& points) {
    // The dilatation of a node's patch: sum over its triangles of volume x dilatation, over the sum of volumes.
    std::fill(patches_.dilatation.begin(), patches_.dilatation.end(), 0.0);
    std::fill(patches_.volume.begin(), patches_.volume.end(), 0.0);
    const int32_t* slot = patches_.corner_slot.data();
    for (const int32_t c : patches_.triangles) {
        const auto g = gradient<Tri3>(c, 0);
        const double volume = cell_volume(points, c);
        for (size_t a = 0; a < 3; ++a) {
            const auto node = static_cast<size_t>(cell_nodes(mesh, c)[a]);
            patches_.volume[node] += volume;
            for (size_t b = 0; b < 3; ++b) {
                double* const out =
                    patches_.dilatation.data() + 2 * (patches_.start[node] + static_cast<size_t>(*slot++));
                out[0] += volume * g[b][0];
                out[1] += volume * g[b][1];
            }
        }
    }
    const int32_t* to_stencil = patches_.stencil_slot.data();
    for (const int32_t c : patches_.triangles) {
        const size_t start = stencil_start_[static_cast<size_t>(c)];
        double* const b = dilatation_.data() + 2 * start;
        std::fill(b, dilatation_.data() + 2 * stencil_start_[static_cast<size_t>(c) + 1], 0.0);
        for (size_t a = 0; a < 3; ++a) {
            const auto node = static_cast<size_t>(cell_nodes(mesh, c)[a]);
            const double share = 1 / (3 * patches_.volume[node]);
            for (size_t k = patches_.start[node]; k < patches_.start[node + 1]; ++k) {
                double* const out = b + 2 * static_cast<size_t>(*to_stencil++);
                out[0] += share * patches_.dilatation[2 * k];
                out[1] += share * patches_.dilatation[2 * k + 1];
            }
        }
    }
}

}  // namespace talus

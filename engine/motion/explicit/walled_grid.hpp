// The grid's nodes that points reach, and the walls that hold the ground, as mirrors between nodes.
#pragma once

#include "background/grid.hpp"
#include "motion/explicit/threads.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace talus {

/// roller: no motion across the wall, nothing held along it; fixed: no motion; friction: the ground may slide, held by Coulomb's
/// friction, and leave the wall.
enum class WallKind { none, roller, fixed, friction };

/// A plane that holds the ground, along an axis of the grid and as long as the grid.
struct Wall {
    WallKind kind = WallKind::none;
    double place = 0;     ///< x of a left or right wall, y of the base or the top, m
    double friction = 0;  ///< tangent of the friction angle
};

struct Walls {
    Wall left, right, base, top{};
};

/// The columns of a row that points may reach; none where first = last.
struct Span {
    int32_t first = 0;
    int32_t last = 0;
};

/// Two nodes on either side of a wall.
struct NodePair {
    size_t inside, beyond;
};

/// Where two walls meet that rub.
struct Corner {
    const Wall *side, *level;      ///< left or right; base or top
    int32_t inwards_x, inwards_y;  ///< the directions in which the ground lies, 1 or -1
    std::array<size_t, 4> nodes;   ///< inside, beyond the side, beyond the level, beyond both
};

/// What the components of a vector beyond a wall are times, to be seen in the mirror.
struct Mirror {
    double x, y;
};

/// Of a wall across an axis, as water and scalars see it, and as the ground held by it does.
inline Mirror even_mirror(size_t axis) { return axis == 0 ? Mirror{-1, 1} : Mirror{1, -1}; }
inline Mirror mirror_of(const Wall& wall, size_t axis) {
    return wall.kind == WallKind::fixed ? Mirror{-1, -1} : even_mirror(axis);
}

struct WalledGrid {
    Grid grid;
    Walls walls;
    std::vector<Span> spans;  ///< one a row: outside them all is zero
    Threads threads;

    [[nodiscard]] bool rubs_along_walls() const {
        const auto rubs = [](const Wall& wall) { return wall.kind == WallKind::friction; };
        return rubs(walls.left) || rubs(walls.right) || rubs(walls.base) || rubs(walls.top);
    }

    /// No cells, their edges where the walls are.
    void start_grid() {
        grid.corner = {walls.left.kind != WallKind::none ? walls.left.place : walls.right.place, walls.base.place};
        grid.cells = {};
    }

    template <class Use>
    void for_each_node(const Use& use) const;

    /// Parts of the grid, of so many rows, are the same for any number of threads.
    static constexpr size_t rows_a_part = 8;
    [[nodiscard]] size_t parts() const { return (spans.size() + rows_a_part - 1) / rows_a_part; }
    template <class Use>
    void for_each_node_of(size_t part, const Use& use) const;

    /// The row or column of nodes inside a wall; -1 where no point is near.
    [[nodiscard]] int32_t line_at(const Wall& wall, size_t axis, int32_t inwards) const {
        const int32_t line = grid.cell_of(wall.place + 0.5 * inwards * grid.cell_size, axis);
        return line < 1 || line + 1 >= grid.cells[axis] ? -1 : line;
    }

    /// use(nodes) for the pairs along a wall; `inwards` is the direction of the axis in which the ground lies, 1 or -1.
    template <class Use>
    void for_each_pair(const Wall& wall, size_t axis, int32_t inwards, const Use& use) const;

    /// use(wall, axis, inwards)
    template <class Use>
    void for_each_wall(const Use& use) const;

    /// use(corner) for every two walls with friction that meet within reach of the points.
    template <class Use>
    void for_each_corner(const Use& use) const;

    /// use(nodes, mirror) for every pair that a roller or a fixed wall mirrors, wall after wall: in a corner, sums go from node to node.
    template <class Use>
    void for_each_mirror(const Use& use) const;
};

template <class Use>
void WalledGrid::for_each_node_of(size_t part, const Use& use) const {
    const auto stride = static_cast<size_t>(grid.cells[0]);
    const size_t last_row = std::min((part + 1) * rows_a_part, spans.size());
    for (size_t row = part * rows_a_part; row < last_row; ++row) {
        const size_t first = row * stride + static_cast<size_t>(spans[row].first);
        const size_t last = row * stride + static_cast<size_t>(spans[row].last);
        for (size_t node = first; node < last; ++node) use(node);
    }
}

template <class Use>
void WalledGrid::for_each_node(const Use& use) const {
    for (size_t part = 0; part < parts(); ++part) for_each_node_of(part, use);
}

template <class Use>
void WalledGrid::for_each_pair(const Wall& wall, size_t axis, int32_t inwards, const Use& use) const {
    const auto stride = static_cast<size_t>(grid.cells[0]);
    const int32_t line = line_at(wall, axis, inwards);
    if (line < 0) return;
    // g++ 12 was seen to clear the nodes beyond a wall, all at once, before they were read. One pair after the other:
    const auto use_in_turn = [&](NodePair nodes) {
        use(nodes);
        std::atomic_signal_fence(std::memory_order_seq_cst);
    };
    const auto inside = static_cast<size_t>(line);
    if (axis == 1) {
        for (auto column = static_cast<size_t>(spans[inside].first); column < static_cast<size_t>(spans[inside].last);
             ++column)
            use_in_turn({inside * stride + column, (inwards > 0 ? inside - 1 : inside + 1) * stride + column});
        return;
    }
    for (size_t row = 0; row < spans.size(); ++row) {
        if (line < spans[row].first || line >= spans[row].last) continue;
        const size_t node = row * stride + inside;
        use_in_turn({node, inwards > 0 ? node - 1 : node + 1});
    }
}

template <class Use>
void WalledGrid::for_each_wall(const Use& use) const {
    use(walls.left, size_t{0}, 1);
    use(walls.right, size_t{0}, -1);
    use(walls.base, size_t{1}, 1);
    use(walls.top, size_t{1}, -1);
}

template <class Use>
void WalledGrid::for_each_corner(const Use& use) const {
    struct Facing {
        const Wall* wall;
        int32_t inwards;
    };
    const auto stride = static_cast<size_t>(grid.cells[0]);
    for (const Facing side : {Facing{&walls.left, 1}, Facing{&walls.right, -1}}) {
        for (const Facing level : {Facing{&walls.base, 1}, Facing{&walls.top, -1}}) {
            if (side.wall->kind != WallKind::friction || level.wall->kind != WallKind::friction) continue;
            const int32_t column = line_at(*side.wall, 0, side.inwards), row = line_at(*level.wall, 1, level.inwards);
            if (column < 0 || row < 0) continue;
            const Span& span = spans[static_cast<size_t>(row)];
            if (column < span.first || column >= span.last) continue;
            const auto first = static_cast<size_t>(row) * stride,
                       beyond = static_cast<size_t>(row - level.inwards) * stride;
            const auto inside = static_cast<size_t>(column), outside = static_cast<size_t>(column - side.inwards);
            use(Corner{side.wall,
                       level.wall,
                       side.inwards,
                       level.inwards,
                       {first + inside, first + outside, beyond + inside, beyond + outside}});
        }
    }
}

template <class Use>
void WalledGrid::for_each_mirror(const Use& use) const {
    for_each_wall([&](const Wall& wall, size_t axis, int32_t inwards) {
        if (wall.kind != WallKind::roller && wall.kind != WallKind::fixed) return;
        const Mirror mirror = mirror_of(wall, axis);
        for_each_pair(wall, axis, inwards, [&](NodePair nodes) { use(nodes, mirror); });
    });
}

}  // namespace talus

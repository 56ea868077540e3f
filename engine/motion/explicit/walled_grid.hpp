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

    /// Whether the ground never leaves it.
    [[nodiscard]] bool mirrors() const { return kind == WallKind::roller || kind == WallKind::fixed; }
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
    std::vector<Span> spans;     ///< one a row: outside them all is zero
    std::vector<uint8_t> still;  ///< one a node: not 0 where held points reach it, and nothing moves; empty: none is
    Threads threads;

    [[nodiscard]] bool is_still(size_t node) const { return !still.empty() && still[node] != 0; }

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
    template <class Use>
    void for_each_level_pair(const Wall& wall, int32_t inwards, const Use& use) const;
    /// The two nodes of a pair along an upright wall are in one row.
    template <class Use>
    void for_each_upright_pair(const Wall& wall, int32_t inwards, size_t first_row, size_t last_row,
                               const Use& use) const;

    /// use(wall, axis, inwards)
    template <class Use>
    void for_each_wall(const Use& use) const;

    /// use(corner) for every two walls with friction that meet within reach of the points.
    template <class Use>
    void for_each_corner(const Use& use) const;

    /// use(nodes, mirror, even) for every pair that a level roller or fixed wall mirrors; `even` is what water and scalars see, to which every wall
    /// is a roller. What comes inside by these goes on by those along upright walls, part by part, and what is mirrored comes the other way: so it
    /// goes from node to node in a corner, and threads leave each other's rows alone.
    template <class Use>
    void for_each_level_mirror(const Use& use) const;
    template <class Use>
    void for_each_upright_mirror_of(size_t part, const Use& use) const;
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

/// g++ 12 was seen to clear the nodes beyond a wall, all at once, before they were read. One pair after the other:
template <class Use>
void use_in_turn(const Use& use, NodePair nodes) {
    use(nodes);
    std::atomic_signal_fence(std::memory_order_seq_cst);
}

template <class Use>
void WalledGrid::for_each_pair(const Wall& wall, size_t axis, int32_t inwards, const Use& use) const {
    if (axis == 1) return for_each_level_pair(wall, inwards, use);
    for_each_upright_pair(wall, inwards, 0, spans.size(), use);
}

template <class Use>
void WalledGrid::for_each_level_pair(const Wall& wall, int32_t inwards, const Use& use) const {
    const int32_t line = line_at(wall, 1, inwards);
    if (line < 0) return;
    const auto inside = static_cast<size_t>(line), beyond = static_cast<size_t>(line - inwards),
               stride = static_cast<size_t>(grid.cells[0]);
    const auto last = static_cast<size_t>(spans[inside].last);
    for (auto column = static_cast<size_t>(spans[inside].first); column < last; ++column)
        use_in_turn(use, {inside * stride + column, beyond * stride + column});
}

template <class Use>
void WalledGrid::for_each_upright_pair(const Wall& wall, int32_t inwards, size_t first_row, size_t last_row,
                                       const Use& use) const {
    const int32_t line = line_at(wall, 0, inwards);
    if (line < 0) return;
    const auto inside = static_cast<size_t>(line), beyond = static_cast<size_t>(line - inwards),
               stride = static_cast<size_t>(grid.cells[0]);
    for (size_t row = first_row; row < last_row; ++row) {
        if (line < spans[row].first || line >= spans[row].last) continue;
        use_in_turn(use, {row * stride + inside, row * stride + beyond});
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
void WalledGrid::for_each_level_mirror(const Use& use) const {
    const auto use_along = [&](const Wall& wall, int32_t inwards) {
        if (!wall.mirrors()) return;
        const Mirror mirror = mirror_of(wall, 1), even = even_mirror(1);
        for_each_level_pair(wall, inwards, [&](NodePair nodes) { use(nodes, mirror, even); });
    };
    use_along(walls.base, 1);
    use_along(walls.top, -1);
}

template <class Use>
void WalledGrid::for_each_upright_mirror_of(size_t part, const Use& use) const {
    const size_t first_row = part * rows_a_part, last_row = std::min(first_row + rows_a_part, spans.size());
    const auto use_along = [&](const Wall& wall, int32_t inwards) {
        if (!wall.mirrors()) return;
        const Mirror mirror = mirror_of(wall, 0), even = even_mirror(0);
        for_each_upright_pair(wall, inwards, first_row, last_row, [&](NodePair nodes) { use(nodes, mirror, even); });
    };
    use_along(walls.left, 1);
    use_along(walls.right, -1);
}

}  // namespace talus

#include "motion/collapse.hpp"

#include <algorithm>
#include <cmath>

namespace talus {

bool CollapseWatch::add(double displacement, double surplus, double cosine) {
    constexpr double least_persistence = 0.95;
    constexpr double largest_fall = 0.1;

    history_.push_back({displacement, surplus, cosine});
    evidence_.displacement = displacement;
    evidence_.surplus = surplus;
    evidence_.persistence = 1;
    for (auto entry = history_.rbegin(); entry != history_.rend(); ++entry) {
        evidence_.earlier_surplus = entry->surplus;
        if (entry->displacement <= displacement / 2) break;
        evidence_.persistence = std::min(evidence_.persistence, entry->cosine);
    }
    return displacement > evidence_.elastic_displacement && evidence_.persistence >= least_persistence && surplus > 0 &&
           surplus >= (1 - largest_fall) * evidence_.earlier_surplus;
}

void locate_mechanism(const CellKinematics& kinematics, const Points& points, std::span<const double> velocity,
                      CollapseEvidence& evidence) {
    const auto dimension = static_cast<size_t>(points.dimension);
    double fastest = 0, largest_shear = -1, moving = 0;
    for (size_t i = 0; i < velocity.size(); i += dimension) {
        fastest = std::max(fastest, std::hypot(velocity[i], dimension == 2 ? velocity[i + 1] : 0.0));
    }
    evidence.place = {};
    for_each_block(kinematics.blocks(), [&](auto shape, const CellBlock& block) {
        using Shape = decltype(shape);
        for (const int32_t c : block.cells) {
            const auto first = static_cast<size_t>(points.cell_start[static_cast<size_t>(c)]);
            const auto u = gather_increment<Shape>(kinematics.stencil(c), velocity.data());
            const double dilatation = mean_dilatation<Shape>(kinematics, c, velocity.data());
            for (size_t i = 0; i < Shape::points; ++i) {
                const size_t p = first + i;
                const auto value = Shape::values(Shape::point[i]);
                std::array<double, 2> v{}, place{};
                for (size_t k = 0; k < Shape::dimension; ++k) {
                    const size_t axis = k + 2 - Shape::dimension;  // a column's only axis is y
                    place[axis] = points.position[p * Shape::dimension + k];
                    for (size_t a = 0; a < Shape::nodes; ++a) v[axis] += value[a] * u[a][k];
                }
                const auto gradient = displacement_gradient<Shape>(kinematics.gradient<Shape>(c, i), u);
                Eigen::Vector4d rate = strain_increment<Shape>(gradient, dilatation);
                rate.head<3>().array() -= rate.head<3>().mean();
                const double shear = rate.head<3>().squaredNorm() + rate[3] * rate[3] / 2;
                if (shear > largest_shear) {
                    largest_shear = shear;
                    evidence.shear_place = place;
                }
                if (std::hypot(v[0], v[1]) < fastest / 2) continue;
                moving += points.volume[p];
                for (size_t k = 0; k < 2; ++k) evidence.place[k] += points.volume[p] * place[k];
            }
        }
    });
    for (double& x : evidence.place) x = moving > 0 ? x / moving : 0.0;
}

}  // namespace talus

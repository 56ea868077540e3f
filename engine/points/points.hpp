// Material points: they carry the state of the ground. Structure of arrays; the components of a field stay together
// (points x components). A field that the scene's physics does not name stays empty.
#pragma once

#include <cstdint>
#include <vector>

namespace talus {

struct Points {
    int32_t dimension = 2;
    int32_t count = 0;
    std::vector<int32_t>
        cell_start;  ///< cells + 1: the points of cell c are cell_start[c] ... cell_start[c+1] - 1, its quadrature
    std::vector<int32_t> soil;     ///< index into Scene::soils
    std::vector<double> position;  ///< points x dimension, m
    std::vector<double> volume;    ///< m3 per metre of thickness (m2 in plane strain, m in a column)

    // A deforming skeleton. Tensors are xx, yy, zz, xy, tension positive, shear strain as the angle gamma_xy.
    std::vector<double> displacement;        ///< points x dimension, m, since the start
    std::vector<double> skeleton_stress;     ///< points x 4, Pa: net stress, or Bishop's effective stress
    std::vector<double> strain;              ///< points x 4, since the start
    std::vector<double> plastic_strain;      ///< equivalent plastic shear strain, -
    std::vector<double> mobilised_strength;  ///< share of the shear strength in use, 0 to 1

    // Water
    std::vector<double> pressure;    ///< Pa
    std::vector<double> saturation;  ///< -
    std::vector<double> porosity;    ///< -
    std::vector<double> darcy_flux;  ///< points x dimension, m/s
};

}  // namespace talus

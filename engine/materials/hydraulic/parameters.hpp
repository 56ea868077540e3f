// What a scene says about how a soil holds and conducts water.
// Source of the models: van Genuchten (1980), Mualem (1976), Gardner (1958), Brooks & Corey (1964).
#pragma once

#include <limits>
#include <vector>

namespace talus {

enum class RetentionModel { van_genuchten, gardner, brooks_corey, tabulated };

/// Saturation S = residual + (maximum - residual) S_e(suction).
///   van_genuchten: S_e = [1 + (alpha s)^n]^-(1 - 1/n)
///   gardner:       S_e = exp(-alpha s)
///   brooks_corey:  S_e = min(1, (alpha s)^-n), 1/alpha being the air-entry suction
///   tabulated:     monotone cubic through (suction, saturation), constant beyond its ends
struct Retention {
    RetentionModel model = RetentionModel::van_genuchten;
    double alpha = 0;                ///< 1/Pa
    double n = 0;                    ///< -, not used by gardner and tabulated
    double residual_saturation = 0;  ///< -
    double maximum_saturation = 1;   ///< -
    std::vector<double> suction;     ///< Pa, tabulated only, increasing from 0
    std::vector<double> saturation;  ///< -, tabulated only, not increasing
};

/// S_e: the share of what drains that is held, -.
inline double effective_of_saturation(const Retention& retention, double saturation) {
    return (saturation - retention.residual_saturation) /
           (retention.maximum_saturation - retention.residual_saturation);
}

enum class PermeabilityModel { mualem, constant, gardner, power, brooks_corey, tabulated };

/// Relative permeability k_r of the water, between 0 and 1.
///   mualem:       S_e^l [1 - (1 - S_e^{1/m})^m]^2 with m = 1 - 1/n of a van Genuchten retention
///   constant:     1
///   gardner:      exp(-alpha s)
///   power:        S_e^exponent
///   brooks_corey: S_e^(2/n + l + 2), Mualem's integral over a Brooks-Corey retention with this n
///   tabulated:    monotone cubic through (suction, relative_permeability), constant beyond its ends
struct RelativePermeability {
    PermeabilityModel model = PermeabilityModel::mualem;
    double pore_connectivity = 0.5;             ///< l of mualem and brooks_corey, -
    double alpha = 0;                           ///< 1/Pa, gardner only
    double exponent = 0;                        ///< -, power only
    std::vector<double> suction;                ///< Pa, tabulated only, increasing from 0
    std::vector<double> relative_permeability;  ///< -, tabulated only, not increasing
};

/// How the saturated hydraulic conductivity follows the porosity.
enum class PorosityDependence { none, kozeny_carman };

/// Saturated hydraulic conductivity of a soil, m/s of water at the scene's density.
struct Conductivity {
    double along = 0;   ///< along the bedding, m/s
    double across = 0;  ///< across the bedding, m/s
    double dip = 0;     ///< angle of the bedding from the x axis, degrees, counter-clockwise
    PorosityDependence porosity_dependence = PorosityDependence::none;
};

struct Hydraulics {
    Retention retention;
    RelativePermeability relative_permeability;
    Conductivity conductivity;
};

}  // namespace talus

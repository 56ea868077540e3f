#include "materials/hydraulic/curves.hpp"

#include "materials/hydraulic/monotone_cubic.hpp"

#include <algorithm>
#include <cmath>

namespace talus {
namespace {

// u = S_e^{1/m} = 1 / (1 + (alpha s)^n) of van Genuchten, and 1 - u without cancellation.
struct VanGenuchten {
    double u;
    double one_minus_u;
};

VanGenuchten van_genuchten(const Retention& retention, double suction) {
    const double power = std::pow(retention.alpha * suction, retention.n);
    if (!std::isfinite(power)) return {0.0, 1.0};
    return {1.0 / (1.0 + power), power / (1.0 + power)};
}

// S_e^l [1 - (1 - u)^m]^2, written so that neither end cancels.
double mualem(const Retention& retention, double pore_connectivity, double suction) {
    const auto [u, one_minus_u] = van_genuchten(retention, suction);
    if (u <= 0) return 0.0;
    const double m = 1.0 - 1.0 / retention.n;
    const double bracket = u < 0.5 ? -std::expm1(m * std::log1p(-u)) : 1.0 - std::pow(one_minus_u, m);
    return std::pow(u, m * pore_connectivity) * bracket * bracket;
}

double raw_relative_permeability(const Hydraulics& hydraulics, double suction) {
    const RelativePermeability& curve = hydraulics.relative_permeability;
    const Retention& retention = hydraulics.retention;
    switch (curve.model) {
        case PermeabilityModel::mualem: return mualem(retention, curve.pore_connectivity, suction);
        case PermeabilityModel::constant: return 1.0;
        case PermeabilityModel::gardner: return std::exp(-curve.alpha * suction);
        case PermeabilityModel::power: return std::pow(effective_saturation(retention, suction), curve.exponent);
        case PermeabilityModel::brooks_corey:
            return std::pow(effective_saturation(retention, suction),
                            2.0 / retention.n + curve.pore_connectivity + 2.0);
        case PermeabilityModel::tabulated: return monotone_cubic(curve.suction, curve.relative_permeability, suction);
    }
    return 1.0;
}

}  // namespace

double effective_saturation(const Retention& retention, double suction) {
    if (suction <= 0) return 1.0;
    switch (retention.model) {
        case RetentionModel::van_genuchten:
            return std::pow(van_genuchten(retention, suction).u, 1.0 - 1.0 / retention.n);
        case RetentionModel::gardner: return std::exp(-retention.alpha * suction);
        case RetentionModel::brooks_corey: return std::min(1.0, std::pow(retention.alpha * suction, -retention.n));
        case RetentionModel::tabulated: {
            const double value = monotone_cubic(retention.suction, retention.saturation, suction);
            return std::clamp(effective_of_saturation(retention, value), 0.0, 1.0);
        }
    }
    return 1.0;
}

double saturation(const Retention& retention, double suction) {
    const double range = retention.maximum_saturation - retention.residual_saturation;
    return retention.residual_saturation + range * effective_saturation(retention, suction);
}

double relative_permeability(const Hydraulics& hydraulics, double suction) {
    return suction <= 0 ? 1.0 : std::clamp(raw_relative_permeability(hydraulics, suction), 0.0, 1.0);
}

double gas_permeability(const Retention& retention, double suction) {
    if (suction <= 0) return 0.0;
    if (retention.model == RetentionModel::van_genuchten) {
        const double m = 1.0 - 1.0 / retention.n, one_minus_u = van_genuchten(retention, suction).one_minus_u;
        const double dry = one_minus_u < 1 ? -std::expm1(m * std::log1p(-one_minus_u)) : 1.0;  // 1 - S_e
        return std::sqrt(dry) * std::pow(one_minus_u, 2.0 * m);
    }
    const double wet = effective_saturation(retention, suction);
    if (retention.model == RetentionModel::brooks_corey)
        return std::sqrt(1.0 - wet) * std::pow(1.0 - std::pow(wet, 1.0 + 1.0 / retention.n), 2.0);
    return (1.0 - wet) * (1.0 - wet) * (1.0 - wet * wet);
}

double suction_scale(const Retention& retention) {
    if (retention.model != RetentionModel::tabulated) return 1.0 / retention.alpha;
    const auto positive =
        std::find_if(retention.suction.begin(), retention.suction.end(), [](double s) { return s > 0; });
    return positive == retention.suction.end() ? 1.0 : *positive;
}

double kozeny_carman(double porosity) { return porosity * porosity * porosity / ((1.0 - porosity) * (1.0 - porosity)); }

}  // namespace talus

#include "materials/hydraulic/shared_pores.hpp"

#include <algorithm>

namespace talus {
namespace {

/// 1 - S at a given suction: the root between 0 and 1 of (1 - a) x^2 - (1 - a - filled - g) x - g = 0, a = (atmosphere + s) / K, g = gas / K,
/// written so that nothing cancels.
double gas_share(const PoreFluids& fluids, double filled, double gas, double suction) {
    const double rest = std::max(1 - (fluids.atmosphere + suction) / fluids.bulk_modulus, 0.1);
    const double pressed = gas / fluids.bulk_modulus, left = rest - filled - pressed;
    const double root = std::sqrt(left * left + 4 * rest * pressed);
    return left > 0 ? (left + root) / (2 * rest) : 2 * pressed / std::max(root - left, 1e-300);
}

}  // namespace

// Newton's method on x - s(S(x)), which grows with x: S(x) does, at the rate 1 / (P / (1 - S) + K filled / S^2), and s falls with S. The
// suction lies between 0 and that of the least S.
SharedPores press_pores(const SaturationTable& table, const PoreFluids& fluids, double filled, double gas) {
    constexpr int most_iterations = 60;
    constexpr double tolerance = 1e-12;
    double low = 0, high = 1e300, suction = 0, share = 0;
    SaturationTable::MixedState state{};
    for (int i = 0; i < most_iterations; ++i) {
        share = gas_share(fluids, filled, gas, suction);
        const double wet = 1 - share, effective = table.effective(wet);
        const double logit = std::log(SaturationTable::odds(effective));
        state = table.mixed_at(effective, logit);
        if (state.suction > suction) low = suction;
        if (state.suction < suction) high = suction;
        if (i == 0) high = state.suction;
        const double stiffness = gas / std::max(share * share, 1e-300) + fluids.bulk_modulus * filled / (wet * wet);
        const double step = (state.suction - suction) / (1 - table.suction_slope(effective, logit) / stiffness);
        if (std::abs(step) <= tolerance * (suction + fluids.atmosphere)) break;
        suction += step;
        if (suction <= low || suction >= high) suction = 0.5 * (low + high);
    }
    const double water_pressure = fluids.bulk_modulus * (filled / (1 - share) - 1);
    return {water_pressure, water_pressure + state.suction, share, state};
}

}  // namespace talus

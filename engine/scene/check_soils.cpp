#include "scene/check.hpp"

#include <algorithm>
#include <functional>
#include <limits>

namespace talus {
namespace {

std::string name(RetentionModel model) { return name_of<schema::RetentionModel>(model); }
std::string name(PermeabilityModel model) { return name_of<schema::PermeabilityModel>(model); }
std::string name(SolidModel model) { return name_of<schema::SolidModel>(model); }
std::string name(StrengthModel model) { return name_of<schema::StrengthModel>(model); }

/// A curve over suction: increasing from 0, one value each, which do not increase.
void check_table(const Check& check, const std::string& values_name, const std::vector<double>& suction,
                 const std::vector<double>& values) {
    if (suction.size() < 2)
        check.at("suction").say("has " + std::to_string(suction.size()) + " numbers; tabulated needs 2 or more");
    check_length(check.at(values_name), values.size(), suction.size(), "suction");
    check.at("suction", 0).require(suction.empty() || suction.front() == 0, "must be 0, where the table starts");
    check_increasing(check.at("suction"), suction);
    const auto rise = std::adjacent_find(values.begin(), values.end(), std::less<>());
    if (rise == values.end()) return;
    check.at(values_name, static_cast<size_t>(rise - values.begin()) + 1)
        .say("= " + value_text(rise[1]) + " is above the one before it; it must not increase with suction");
}

void check_retention(const Check& check, const Retention& retention) {
    using enum RetentionModel;
    const std::string model = name(retention.model);
    const bool table = retention.model == tabulated;
    const bool exponent = retention.model == van_genuchten || retention.model == brooks_corey;
    check.at("alpha").used(!table, given_positive(retention.alpha), model);
    check.at("n").used(exponent, given_positive(retention.n), model);
    check.at("suction").used(table, !retention.suction.empty(), model);
    check.at("saturation").used(table, !retention.saturation.empty(), model);
    check.at("residualSaturation").unused(table && retention.residual_saturation != 0, model);
    check.at("maximumSaturation").unused(table && retention.maximum_saturation != 1, model);
    if (table) check_table(check, "saturation", retention.suction, retention.saturation);

    if (retention.model == van_genuchten && retention.n > 0 && retention.n < 1.01) {
        check.at("n").say("= " + value_text(retention.n) +
                          ": must be between 1.01 and 20 for vanGenuchten (is it m = 1 - 1/n?)");
    }
    check.at("residualSaturation")
        .require(!(retention.residual_saturation >= retention.maximum_saturation),
                 "= " + value_text(retention.residual_saturation) + ": must be below the maximum saturation, " +
                     value_text(retention.maximum_saturation));
}

void check_permeability(const Check& check, const Hydraulics& hydraulics) {
    using enum PermeabilityModel;
    const RelativePermeability& permeability = hydraulics.relative_permeability;
    const Retention& retention = hydraulics.retention;
    const std::string model = name(permeability.model);
    const bool table = permeability.model == tabulated;
    const bool connectivity = permeability.model == mualem || permeability.model == brooks_corey;
    check.at("alpha").used(permeability.model == gardner, given_positive(permeability.alpha), model);
    check.at("exponent").used(permeability.model == power, given_positive(permeability.exponent), model);
    check.at("poreConnectivity").unused(!connectivity && permeability.pore_connectivity != 0.5, model);
    check.at("suction").used(table, !permeability.suction.empty(), model);
    check.at("relativePermeability").used(table, !permeability.relative_permeability.empty(), model);
    if (table) check_table(check, "relativePermeability", permeability.suction, permeability.relative_permeability);

    const auto check_partner = [&](RetentionModel partner) {
        check.at("model").require(retention.model == partner, "= " + model + ": needs a " + name(partner) +
                                                                  " retention, not " + name(retention.model));
        return retention.model == partner;
    };
    // Where S_e -> 0, mualem goes as S_e^(l + 2/m) and brooksCorey as S_e^(2/n + l + 2): it must fall.
    double least = -std::numeric_limits<double>::infinity();
    if (permeability.model == mualem && check_partner(RetentionModel::van_genuchten))
        least = -2 / (1 - 1 / retention.n);
    if (permeability.model == brooks_corey && check_partner(RetentionModel::brooks_corey)) least = -2 - 2 / retention.n;
    check.at("poreConnectivity")
        .require(!(permeability.pore_connectivity <= least),
                 "= " + value_text(permeability.pore_connectivity) + ": must be above " + value_text(least) +
                     " with this n, for the permeability to fall as the soil dries");
}

void check_conductivity(const Check& check, const Conductivity& conductivity) {
    check.at("along").needed(given_positive(conductivity.along), "a soil that conducts water");
    check.at("across").needed(given_positive(conductivity.across), "a soil that conducts water");
}

void check_strength(const Check& check, const Strength& strength) {
    using enum StrengthModel;
    const std::string model = name(strength.model);
    const bool gains = strength.model == exponential;
    check.at("cohesion").needed(given(strength.cohesion), "mohrCoulomb");
    check.at("frictionAngle").needed(given(strength.friction_angle), "mohrCoulomb");
    check.at("suctionFrictionAngle")
        .used(strength.model == fredlund, given_positive(strength.suction_friction_angle), model);
    check.at("cohesionGain").unused(!gains && given_positive(strength.cohesion_gain), model);
    check.at("cohesionRate").unused(!gains && given_positive(strength.cohesion_rate), model);
    check.at("frictionGain").unused(!gains && given_positive(strength.friction_gain), model);
    if (gains) {
        const bool cohesive = given_positive(strength.cohesion_gain);
        check.at("cohesionRate")
            .used(cohesive, given_positive(strength.cohesion_rate),
                  cohesive ? "a cohesionGain" : "a strength without cohesionGain");
        check.at("cohesionGain")
            .needed(cohesive || given_positive(strength.friction_gain), "exponential (or a frictionGain)");
    }
    check.require(!(strength.cohesion == 0 && strength.friction_angle == 0),
                  "has neither cohesion nor friction; must have one");
}

/// Who has no use for what only ground that yields in motion uses.
std::string user_of(const Solid& solid, bool is_dynamic) {
    return is_dynamic ? name(solid.model) : "a ground whose regime is not dynamic";
}

void check_softening(const Check& check, const Solid& solid, bool is_dynamic) {
    const Softening& softening = solid.softening;
    const bool any = given(softening.residual_cohesion) || given(softening.residual_friction_angle) ||
                     given_positive(softening.slip);
    if (!any) return;
    if (solid.model == SolidModel::elastic || !is_dynamic) return check.unused(true, user_of(solid, is_dynamic));
    check.at("residualCohesion").needed(given(softening.residual_cohesion), "softening");
    check.at("residualFrictionAngle").needed(given(softening.residual_friction_angle), "softening");
    check.at("slip").needed(given_positive(softening.slip), "softening");
    check.require(!(softening.residual_cohesion == 0 && softening.residual_friction_angle == 0),
                  "has neither cohesion nor friction; must have one");
    check.at("residualCohesion")
        .require(!(softening.residual_cohesion > solid.strength.cohesion),
                 "= " + value_text(softening.residual_cohesion) + " Pa: must be at most the cohesion, " +
                     value_text(solid.strength.cohesion) + " Pa");
    check.at("residualFrictionAngle")
        .require(!(softening.residual_friction_angle > solid.strength.friction_angle),
                 "= " + value_text(softening.residual_friction_angle) +
                     " degrees: must be at most the friction angle, " + value_text(solid.strength.friction_angle));
}

void check_inertial_friction(const Check& check, const Solid& solid, bool is_dynamic) {
    const InertialFriction& friction = solid.inertial_friction;
    if (!given(friction.limit_friction_angle) && !given_positive(friction.grain_diameter)) return;
    if (solid.model == SolidModel::elastic || !is_dynamic) return check.unused(true, user_of(solid, is_dynamic));
    check.at("grainDiameter").needed(given_positive(friction.grain_diameter), "inertialFriction");
    check.at("limitFrictionAngle").needed(given(friction.limit_friction_angle), "inertialFriction");
    check.at("limitFrictionAngle")
        .require(!(friction.limit_friction_angle < solid.strength.friction_angle),
                 "= " + value_text(friction.limit_friction_angle) + " degrees: must be at least the friction angle, " +
                     value_text(solid.strength.friction_angle));
}

void check_solid(const Check& check, const Solid& solid, bool is_dynamic) {
    const std::string model = name(solid.model);
    check_softening(check.at("softening"), solid, is_dynamic);
    check_inertial_friction(check.at("inertialFriction"), solid, is_dynamic);
    check.at("youngModulus").needed(given_positive(solid.young_modulus), model);
    check.at("poissonRatio").needed(given(solid.poisson_ratio), model);
    if (solid.model == SolidModel::mohr_coulomb) {
        check_strength(check.at("strength"), solid.strength);
        check.at("dilationAngle")
            .require(!(solid.dilation_angle > solid.strength.friction_angle),
                     "= " + value_text(solid.dilation_angle) + " degrees: must be at most the friction angle, " +
                         value_text(solid.strength.friction_angle));
        return;
    }
    const Check strength = check.at("strength");
    strength.at("cohesion").unused(given_positive(solid.strength.cohesion), model);
    strength.at("frictionAngle").unused(given_positive(solid.strength.friction_angle), model);
    check.at("dilationAngle").unused(solid.dilation_angle != 0, model);
    check.at("tensileStrength").unused(std::isfinite(solid.tensile_strength), model);
}

/// Points find their suction by their saturation.
void check_fall(const Check& check, const Retention& retention) {
    const bool is_flat = retention.saturation.size() > 1 && retention.saturation.back() == retention.saturation.front();
    check.at("saturation").require(!is_flat, "does not fall; must fall where the regime is not quasiStatic");
}

void check_soil(const Check& check, const Soil& soil, const Physics& physics) {
    check.at("porosity").needed(given(soil.porosity), "every soil");
    const bool moves = physics.regime != MotionRegime::quasi_static;
    if (physics.water) {
        const Check hydraulics = check.at("hydraulics");
        check_retention(hydraulics.at("retention"), soil.hydraulics.retention);
        if (moves) check_fall(hydraulics.at("retention"), soil.hydraulics.retention);
        check_permeability(hydraulics.at("relativePermeability"), soil.hydraulics);
        check_conductivity(hydraulics.at("conductivity"), soil.hydraulics.conductivity);
    }
    if (physics.deforming) {
        check.at("dryDensity").needed(given(soil.dry_density), "a skeleton that deforms");
        check_solid(check.at("solid"), soil.solid, moves);
    }
}

}  // namespace

void check_soils(const Check& scene_check, const Scene& scene) {
    scene_check.at("soils").needed(!scene.soils.empty(), "the ground");
    for (size_t i = 0; i < scene.soils.size(); ++i)
        check_soil(scene_check.at("soils", i), scene.soils[i], scene.physics);
    check_names(scene_check, "soils", scene.soils, true);
}

}  // namespace talus

#include "materials/solid/mohr_coulomb.hpp"

#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <vector>

using namespace talus;
using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::Vector3d;
using Eigen::Vector4d;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double young_modulus = 10e6;
constexpr double poisson_ratio = 0.3;

MohrCoulomb soil(double cohesion, double friction_angle, double dilation_angle, double tensile_strength) {
    return mohr_coulomb({cohesion, friction_angle}, dilation_angle, tensile_strength);
}

// How far a stress lies outside, in Pa; written from the definition, with an eigenvalue solver of its own.
double violation(const MohrCoulomb& material, const Vector4d& stress) {
    Matrix3d tensor = Matrix3d::Zero();
    tensor(0, 0) = stress[0];
    tensor(1, 1) = stress[1];
    tensor(2, 2) = stress[2];
    tensor(0, 1) = tensor(1, 0) = stress[3];
    const Vector3d principal = Eigen::SelfAdjointEigenSolver<Matrix3d>(tensor).eigenvalues();
    const double shear = (principal[2] - principal[0]) / 2 + (principal[2] + principal[0]) / 2 * material.sin_friction -
                         material.cohesion * material.cos_friction;
    return std::max(shear, principal[2] - material.tensile_strength);
}

// A place on the yield surface with the flow that leads there: principal stresses from the largest down, and plastic strains
// in the same order. A trial stress made from both must come back to the stress with that plastic strain.
struct Place {
    std::string name;
    MohrCoulomb material;
    Vector3d stress;
    Vector3d plastic_strain;
    YieldRegion region;
};

// The smallest principal stress that the cone allows beside the largest.
double on_cone(const MohrCoulomb& material, double largest) {
    return ((1 + material.sin_friction) * largest - 2 * material.cohesion * material.cos_friction) /
           (1 - material.sin_friction);
}

std::vector<Place> places(double cohesion, double friction_angle, double dilation_angle, double tensile_strength) {
    const MohrCoulomb cone = soil(cohesion, friction_angle, dilation_angle, infinity);
    const MohrCoulomb cut = soil(cohesion, friction_angle, dilation_angle, tensile_strength);
    const double up = 1 + cone.sin_dilation;
    const double down = cone.sin_dilation - 1;
    const Vector3d shear_13 = 1e-3 * Vector3d(up, 0, down);
    const Vector3d shear_12 = 1e-3 * Vector3d(up, down, 0);
    const Vector3d shear_23 = 1e-3 * Vector3d(0, up, down);
    const Vector3d tension_1 = 1e-3 * Vector3d::UnitX();
    const Vector3d tension_2 = 1e-3 * Vector3d::UnitY();
    const Vector3d tension_3 = 1e-3 * Vector3d::UnitZ();

    const double largest = -20e3;
    const double smallest = on_cone(cone, largest);
    const double middle = (largest + smallest) / 2;
    const double limit = cut.tensile_strength;
    const double corner = on_cone(cut, limit);
    const double between = (limit + corner) / 2;
    std::vector<Place> all{
        {"main plane", cone, {largest, middle, smallest}, shear_13, YieldRegion::shear},
        {"edge s2 = s3", cone, {largest, smallest, smallest}, 2 * shear_13 + shear_12, YieldRegion::shear_edge},
        {"edge s1 = s2", cone, {largest, largest, smallest}, 2 * shear_13 + shear_23, YieldRegion::shear_edge},
        {"tension plane", cut, {limit, between, corner + 0.4 * (between - corner)}, tension_1, YieldRegion::tension},
        {"tension edge", cut, {limit, limit, between}, 2 * tension_1 + tension_2, YieldRegion::tension},
        {"tension corner", cut, {limit, limit, limit}, 3 * tension_1 + 2 * tension_2 + tension_3, YieldRegion::apex},
        {"shear and tension", cut, {limit, between, corner}, shear_13 + 2 * tension_1, YieldRegion::shear_tension},
        {"edge s2 = s3 and tension",
         cut,
         {limit, corner, corner},
         2 * shear_13 + shear_12 + tension_1,
         YieldRegion::shear_tension},
        {"edge s1 = s2 and tension, shear first",
         cut,
         {limit, limit, corner},
         2 * shear_13 + shear_23 + tension_2,
         YieldRegion::shear_tension},
        {"edge s1 = s2 and tension, tension first",
         cut,
         {limit, limit, corner},
         shear_13 + 2 * tension_1 + tension_2,
         YieldRegion::shear_tension}};
    if (friction_angle > 0) {
        const double apex = cone.cohesion * cone.cos_friction / cone.sin_friction;
        all.push_back({"apex", cone, {apex, apex, apex}, 3 * tension_1 + 2 * tension_2 + tension_3, YieldRegion::apex});
        all.push_back(
            {"apex, sheared", cone, {apex, apex, apex}, 2 * shear_13 + shear_12 + tension_1, YieldRegion::apex});
    }
    return all;
}

// Every orientation: which principal stress is out of the plane, and the angle of the others.
struct Orientation {
    int out_of_plane;
    double angle;
};

const std::array<Orientation, 6> orientations{
    {{0, 0.0}, {0, 2.0}, {1, 0.7}, {1, -1.2}, {2, 0.5}, {2, std::numbers::pi / 4}}};

// Principal values in the directions of an orientation, as (xx, yy, zz, xy).
Vector4d oriented(const Vector3d& principal, const Orientation& orientation) {
    const double out_of_plane = principal[orientation.out_of_plane];
    const double major = principal[orientation.out_of_plane == 0 ? 1 : 0];
    const double minor = principal[orientation.out_of_plane == 2 ? 1 : 2];
    const double cosine = std::cos(orientation.angle);
    const double sine = std::sin(orientation.angle);
    return {major * cosine * cosine + minor * sine * sine, major * sine * sine + minor * cosine * cosine, out_of_plane,
            (major - minor) * cosine * sine};
}

Vector4d oriented_strain(const Vector3d& principal, const Orientation& orientation) {
    Vector4d strain = oriented(principal, orientation);
    strain[3] *= 2;
    return strain;
}

Matrix4d tangent_by_differences(const Elasticity& elastic, const MohrCoulomb& material, const Vector4d& trial) {
    const Matrix4d stiffness = elastic_stiffness(elastic);
    const double step = 1e-6 * trial.cwiseAbs().maxCoeff() / stiffness(0, 0);
    Matrix4d result;
    Matrix4d unused;
    for (int j = 0; j < 4; ++j) {
        const Vector4d change = stiffness.col(j) * step;
        result.col(j) = (return_stress(elastic, material, trial + change, &unused).stress -
                         return_stress(elastic, material, trial - change, &unused).stress) /
                        (2 * step);
    }
    return result;
}

struct Soil {
    double cohesion, friction_angle, dilation_angle, tensile_strength;
};

const std::array<Soil, 8> soils{{{12e3, 30, 0, 5e3},
                                 {12e3, 30, 30, 5e3},
                                 {12e3, 30, 12, 0},
                                 {25e3, 0, 0, 8e3},
                                 {4e3, 50, 50, 1e3},
                                 {4e3, 50, 0, 1e3},
                                 {1e3, 5, 2, 500},
                                 {12e3, 1e-3, 0, 9e3}}};

template <class Check>
void for_each_place(Check check) {
    for (const double poisson_ratio : {0.2, 0.49})
        for (const Soil& s : soils)
            for (const Place& place : places(s.cohesion, s.friction_angle, s.dilation_angle, s.tensile_strength))
                for (const Orientation& orientation : orientations) {
                    CAPTURE(place.name);
                    CAPTURE(poisson_ratio);
                    CAPTURE(s.friction_angle);
                    CAPTURE(s.dilation_angle);
                    CAPTURE(orientation.out_of_plane);
                    CAPTURE(orientation.angle);
                    check(elasticity(young_modulus, poisson_ratio), place, orientation);
                }
}

// Soils and trial stresses over wide ranges, many of them special: no cohesion, no friction, equal or vanishing components.
class Sweep {
public:
    explicit Sweep(unsigned seed) : random(seed) {}

    double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); }
    bool one_in(int n) { return std::uniform_int_distribution<int>(1, n)(random) == 1; }
    double magnitude(double from, double to) { return std::exp(uniform(std::log(from), std::log(to))); }

    Elasticity elastic() { return elasticity(magnitude(1e4, 1e10), one_in(5) ? 0.4999 : uniform(-0.3, 0.49)); }

    MohrCoulomb material() {
        const double cohesion = one_in(5) ? 0 : magnitude(1, 1e6);
        const double friction_angle = one_in(8) ? 0 : one_in(8) ? magnitude(1e-9, 1) : uniform(0, 50);
        const double dilation_angle = one_in(3) ? 0 : one_in(3) ? friction_angle : uniform(0, friction_angle);
        const double tensile_strength = one_in(2) ? infinity : one_in(3) ? 0 : magnitude(1, 1e6);
        return soil(cohesion, friction_angle, dilation_angle, tensile_strength);
    }

    Vector4d stress() {
        const double size = magnitude(1, 1e8);
        Vector4d result(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
        if (one_in(5)) result += uniform(-5, 5) * Vector4d(1, 1, 1, 0);
        if (one_in(5)) result[1] = result[0];
        if (one_in(5)) result[2] = result[0];
        if (one_in(5)) result[3] *= one_in(2) ? 0 : 1e-9;
        return size * result;
    }

private:
    std::mt19937_64 random;
};

}  // namespace

TEST_CASE("elasticity: stiffness against Hooke's law by hand") {
    const Elasticity elastic = elasticity(10e6, 0.25);
    CHECK(elastic.shear == doctest::Approx(4e6));
    CHECK(elastic.lame == doctest::Approx(4e6));
    const Vector4d stress = elastic_stiffness(elastic) * Vector4d(1e-3, -2e-3, 0, 3e-3);
    CHECK(stress.isApprox(Vector4d(4e3, -20e3, -4e3, 12e3), 1e-14));
}

TEST_CASE("Mohr-Coulomb: an admissible stress stands, with the elastic tangent") {
    const Elasticity elastic = elasticity(young_modulus, poisson_ratio);
    const MohrCoulomb material = soil(12e3, 30, 0, 5e3);
    Matrix4d tangent;
    for (const Vector4d& trial :
         {Vector4d(0, 0, 0, 0), Vector4d(-50e3, -100e3, -50e3, 20e3), Vector4d(4.9e3, 0, 0, 0)}) {
        const PlasticReturn result = return_stress(elastic, material, trial, &tangent);
        CHECK(result.region == YieldRegion::elastic);
        CHECK(result.stress == trial);
        CHECK(result.plastic_strain == Vector4d::Zero());
        CHECK(result.plastic_shear_strain == 0);
        CHECK(tangent == elastic_stiffness(elastic));
    }
}

TEST_CASE("Mohr-Coulomb: every region gives back the stress and the plastic strain that its trial stress was made of") {
    for_each_place([](const Elasticity& elastic, const Place& place, const Orientation& orientation) {
        const Matrix4d stiffness = elastic_stiffness(elastic);
        const Vector4d stress = oriented(place.stress, orientation);
        const Vector4d plastic_strain = oriented_strain(place.plastic_strain, orientation);
        const Vector4d trial = stress + stiffness * plastic_strain;
        Matrix4d tangent;
        const PlasticReturn result = return_stress(elastic, place.material, trial, &tangent);
        const double scale = trial.cwiseAbs().maxCoeff();
        CHECK(result.region == place.region);
        CHECK((result.stress - stress).cwiseAbs().maxCoeff() < 1e-10 * scale);
        CHECK((result.plastic_strain - plastic_strain).cwiseAbs().maxCoeff() < 1e-10 * scale / elastic.shear);
        CHECK(std::abs(violation(place.material, result.stress)) < 1e-9 * scale);
    });
}

TEST_CASE("Mohr-Coulomb: the tangent is the derivative of the returned stress in every region") {
    for_each_place([](const Elasticity& elastic, const Place& place, const Orientation& orientation) {
        const Matrix4d stiffness = elastic_stiffness(elastic);
        const Vector4d trial =
            oriented(place.stress, orientation) + stiffness * oriented_strain(place.plastic_strain, orientation);
        Matrix4d tangent;
        return_stress(elastic, place.material, trial, &tangent);
        const Matrix4d differences = tangent_by_differences(elastic, place.material, trial);
        CHECK((tangent - differences).cwiseAbs().maxCoeff() < 1e-6 * stiffness(0, 0));
    });
}

TEST_CASE("Mohr-Coulomb: the tangent where two trial principal stresses are equal") {
    const Elasticity elastic = elasticity(young_modulus, poisson_ratio);
    const Matrix4d stiffness = elastic_stiffness(elastic);
    const MohrCoulomb material = soil(12e3, 30, 10, 5e3);
    struct Case {
        Vector4d trial;
        YieldRegion region;
    };
    const std::array<Case, 5> cases{{{{-300e3, -300e3, -20e3, 0}, YieldRegion::shear_edge},
                                     {{-20e3, -20e3, -300e3, 0}, YieldRegion::shear_edge},
                                     {{30e3, 30e3, 0, 0}, YieldRegion::tension},
                                     {{0, 0, 30e3, 0}, YieldRegion::tension},
                                     {{30e3, 30e3, 30e3, 0}, YieldRegion::apex}}};
    for (const Case& c : cases)
        for (const double difference :
             {0.0, 1e-9, 1e-5, 1e-3, 0.1}) {  // Pa: across the change from the quotient to its limit
            CAPTURE(c.trial.transpose());
            CAPTURE(difference);
            const Vector4d trial = c.trial + difference * Vector4d(1, -1, 0, 0.3);
            Matrix4d tangent;
            CHECK(return_stress(elastic, material, trial, &tangent).region == c.region);
            const Matrix4d differences = tangent_by_differences(elastic, material, trial);
            CHECK((tangent - differences).cwiseAbs().maxCoeff() < 1e-6 * stiffness(0, 0));
        }
}

TEST_CASE("Mohr-Coulomb: associated flow has a symmetric tangent and dissipates") {
    Sweep sweep(1);
    for (int i = 0; i < 20000; ++i) {
        const Elasticity elastic = sweep.elastic();
        MohrCoulomb material = sweep.material();
        material.sin_dilation = material.sin_friction;
        const Vector4d trial = sweep.stress();
        Matrix4d tangent;
        const PlasticReturn result = return_stress(elastic, material, trial, &tangent);
        const double stiffness = elastic.lame + 2 * elastic.shear;
        REQUIRE((tangent - tangent.transpose()).cwiseAbs().maxCoeff() < 1e-9 * (stiffness + elastic.shear));
        const double size = trial.cwiseAbs().maxCoeff();
        REQUIRE(result.stress.dot(result.plastic_strain) >= -1e-12 * size * size / elastic.shear);
    }
}

TEST_CASE("Mohr-Coulomb: associated flow returns to the closest admissible stress in the norm of the elastic energy") {
    Sweep sweep(2);
    for (int i = 0; i < 1000; ++i) {
        const Elasticity elastic = sweep.elastic();
        MohrCoulomb material = sweep.material();
        material.sin_dilation = material.sin_friction;
        const Vector4d trial = sweep.stress();
        Matrix4d unused;
        const PlasticReturn result = return_stress(elastic, material, trial, &unused);
        const double size = trial.cwiseAbs().maxCoeff();
        double closer = 0;  // work of the plastic strain towards another admissible stress, over its round-off
        for (int j = 0; j < 20; ++j) {
            const Vector4d other_trial = sweep.stress();
            const Vector4d other = return_stress(elastic, material, other_trial, &unused).stress;
            const double round_off = 1e-12 * std::max(size, other_trial.cwiseAbs().maxCoeff()) * size / elastic.shear;
            closer = std::max(closer, result.plastic_strain.dot(other - result.stress) / round_off);
        }
        REQUIRE(closer <= 1);
    }
}

TEST_CASE("Mohr-Coulomb: 100000 stresses return to the yield surface, with nothing that is not a number") {
    Sweep sweep(3);
    std::map<YieldRegion, int> seen;
    double worst_violation = 0;  // relative to the trial stress, as is the next
    double worst_balance = 0;    // of trial stress = stress + D plastic strain
    int not_finite = 0;
    for (int i = 0; i < 100000; ++i) {
        const Elasticity elastic = sweep.elastic();
        const MohrCoulomb material = sweep.material();
        const Vector4d trial = sweep.stress();
        Matrix4d tangent;
        const PlasticReturn result = return_stress(elastic, material, trial, &tangent);
        const bool finite = result.stress.allFinite() && tangent.allFinite() && result.plastic_strain.allFinite() &&
                            std::isfinite(result.plastic_shear_strain);
        if (!finite) ++not_finite;
        const double size = trial.cwiseAbs().maxCoeff();
        const double outside = violation(material, result.stress) / size;
        worst_violation =
            std::max(worst_violation, result.region == YieldRegion::elastic ? outside : std::abs(outside));
        const Vector4d relaxed = elastic_stiffness(elastic) * result.plastic_strain;
        worst_balance = std::max(worst_balance, (trial - result.stress - relaxed).cwiseAbs().maxCoeff() / size);
        ++seen[result.region];
    }
    CHECK(not_finite == 0);
    CHECK(worst_violation < 1e-9);
    CHECK(worst_balance < 1e-11);
    CHECK(seen.size() == 6);
    for (const auto& [region, count] : seen) {
        CAPTURE(static_cast<int>(region));
        CHECK(count > 500);
    }
}

TEST_CASE("Mohr-Coulomb: the returned stress does not jump from one region to the next, non-associated flow included") {
    Sweep sweep(4);
    for (int line = 0; line < 150; ++line) {
        const Elasticity elastic = elasticity(young_modulus, sweep.uniform(0, 0.45));
        const double friction_angle = sweep.one_in(6) ? 0 : sweep.uniform(1, 45);
        const double tensile_strength = sweep.one_in(2) ? infinity : sweep.uniform(0, 30e3);
        const MohrCoulomb material = soil(10e3, friction_angle, sweep.uniform(0, friction_angle), tensile_strength);
        const auto random_stress = [&sweep] {
            return Vector4d(sweep.uniform(-1e5, 1e5), sweep.uniform(-1e5, 1e5), sweep.uniform(-1e5, 1e5),
                            sweep.uniform(-1e5, 1e5));
        };
        const Vector4d start = random_stress();
        const int steps = 400;
        const Vector4d change = (random_stress() - start) / steps;
        Matrix4d unused;
        Vector4d before = return_stress(elastic, material, start, &unused).stress;
        double largest_change = 0;
        for (int i = 1; i <= steps; ++i) {
            const Vector4d now = return_stress(elastic, material, start + i * change, &unused).stress;
            largest_change = std::max(largest_change, (now - before).norm());
            before = now;
        }
        CHECK(largest_change < 10 * change.norm());
    }
}

TEST_CASE("Mohr-Coulomb: Tresca keeps the mean stress and half the stress difference at the cohesion") {
    const Elasticity elastic = elasticity(young_modulus, 0.49);
    const MohrCoulomb material = soil(10e3, 0, 0, infinity);
    Sweep sweep(5);
    for (int i = 0; i < 1000; ++i) {
        const Vector4d trial(sweep.uniform(-1e6, 1e6), sweep.uniform(-1e6, 1e6), sweep.uniform(-1e6, 1e6),
                             sweep.uniform(-1e6, 1e6));
        Matrix4d unused;
        const PlasticReturn result = return_stress(elastic, material, trial, &unused);
        REQUIRE(result.region != YieldRegion::elastic);
        const auto [largest, smallest] = extreme_stress(result.stress);
        REQUIRE((largest - smallest) / 2 == doctest::Approx(10e3).epsilon(1e-9));
        REQUIRE(std::abs(result.stress.head<3>().sum() - trial.head<3>().sum()) < 1e-9 * 1e6);
        REQUIRE(std::abs(result.plastic_strain.head<3>().sum()) < 1e-12);
    }
}

TEST_CASE("Mohr-Coulomb: shear dilates by the dilation angle") {
    const Elasticity elastic = elasticity(young_modulus, poisson_ratio);
    Sweep sweep(6);
    for (const double dilation_angle : {0.0, 10.0, 30.0}) {
        const MohrCoulomb material = soil(12e3, 30, dilation_angle, infinity);
        const Vector4d trial(-60e3, -200e3, -90e3, 80e3);
        Matrix4d unused;
        const PlasticReturn result = return_stress(elastic, material, trial, &unused);
        REQUIRE(result.region == YieldRegion::shear);
        const double volume = result.plastic_strain.head<3>().sum();
        const double in_plane_shear =
            std::hypot(result.plastic_strain[0] - result.plastic_strain[1], result.plastic_strain[3]);
        CHECK(volume / in_plane_shear ==
              doctest::Approx(std::sin(dilation_angle * std::numbers::pi / 180)).epsilon(1e-12));
        CHECK(result.plastic_strain[2] == doctest::Approx(0));
        if (dilation_angle == 0)  // then the deviator is (g/2, -g/2, 0)
            CHECK(result.plastic_shear_strain == doctest::Approx(in_plane_shear / std::sqrt(3)).epsilon(1e-12));
    }
}

TEST_CASE("Mohr-Coulomb: dilation is held to the friction angle") {
    CHECK(soil(12e3, 20, 35, infinity).sin_dilation == soil(12e3, 20, 20, infinity).sin_dilation);
}

TEST_CASE("Mohr-Coulomb: a column pressed in yy only, by hand") {
    // c = 0, phi = 30: K_p = 3, so that s_yy = 3 s_xx; no dilation; edge s1 = s2 (xx = zz). With the trial (-a, -b, -a), the mean
    // stress stays, (2 a + b) / 3 = m, and s_xx = -3 m / 5, s_yy = -9 m / 5.
    const Elasticity elastic = elasticity(young_modulus, poisson_ratio);
    Matrix4d tangent;
    const PlasticReturn result =
        return_stress(elastic, soil(0, 30, 0, infinity), Vector4d(-10e3, -100e3, -10e3, 0), &tangent);
    CHECK(result.region == YieldRegion::shear_edge);
    CHECK(result.stress.isApprox(Vector4d(-24e3, -72e3, -24e3, 0), 1e-12));
    CHECK(tangent(1, 1) == doctest::Approx(9.0 / 5 * (elastic.lame + 2.0 / 3 * elastic.shear)).epsilon(1e-12));
}

TEST_CASE("Mohr-Coulomb: factor of safety and mobilised strength") {
    const MohrCoulomb material = soil(12e3, 30, 0, infinity);
    // s1 = -40 kPa, s3 = -100 kPa: q = 30 kPa, p = 70 kPa, available 12 cos 30 + 70 sin 30 = 45.392 kPa
    const Vector4d stress(-100e3, -40e3, -60e3, 0);
    CHECK(factor_of_safety(material, stress) == doctest::Approx(1.5130768282).epsilon(1e-7));
    CHECK(mobilised_strength(material, stress) == doctest::Approx(1 / 1.5130768282).epsilon(1e-7));

    const Elasticity elastic = elasticity(young_modulus, poisson_ratio);
    Matrix4d unused;
    const Vector4d at_yield = return_stress(elastic, material, Vector4d(-60e3, -300e3, -90e3, 80e3), &unused).stress;
    CHECK(factor_of_safety(material, at_yield) == doctest::Approx(1).epsilon(1e-9));
    const Vector4d at_apex = return_stress(elastic, material, Vector4d(90e3, 80e3, 85e3, 3e3), &unused).stress;
    CHECK(factor_of_safety(material, at_apex) == doctest::Approx(1).epsilon(1e-6));
    CHECK(mobilised_strength(material, at_apex) == doctest::Approx(1).epsilon(1e-6));

    const Vector4d hydrostatic(-50e3, -50e3, -50e3, 0);
    CHECK(std::isfinite(factor_of_safety(material, hydrostatic)));
    CHECK(mobilised_strength(material, hydrostatic) < 1e-6);
    const Vector4d beyond_apex(90e3, 80e3, 85e3, 0);
    CHECK(factor_of_safety(material, beyond_apex) == 0);
    CHECK(mobilised_strength(material, beyond_apex) == 1);
    CHECK(factor_of_safety(soil(0, 30, 0, infinity), Vector4d::Zero()) == 1);
}

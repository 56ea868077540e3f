// The return mapping, in sorted principal stresses. There the admissible set is a convex polyhedron of planes
//     f_k = a_k . s - h_k <= 0
// and the stress returned from a trial stress t by the active planes (columns of A; flow directions, columns of B) is
//     s = t - D B l,   l = (A^T D B)^-1 f(t),   ds/de = D - D B (A^T D B)^-1 A^T D,
// with multipliers l >= 0 and no other plane violated. Clausen, Damkilde & Andersen (Comput. Struct. 85, 2007) take the same
// view of non-associated Mohr-Coulomb. Every face, edge and corner has det(A^T D B) > 0 whenever dilation <= friction, e.g.
// 4 G (lame + G) (1 - sin phi)(1 - sin psi) for shear with tension, so that the regions of trial stress which belong to them
// fill space without gap or overlap, and the search below ends with the one answer, up to round-off.
#include "materials/solid/mohr_coulomb.hpp"

#include <Eigen/LU>

#include <array>
#include <limits>
#include <numbers>

namespace talus {

namespace {

using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::Vector3d;
using Eigen::Vector4d;

// The shear planes 12 and 23 meet 13 where two principal stresses become equal; the other three cannot be active when sorted.
enum PlaneName : int { shear_13, shear_12, shear_23, tension_1, tension_2, tension_3, plane_count };

/// All planes, a column each in this order.
struct Planes {
    Eigen::Matrix<double, 3, plane_count> normals, flows;
    Eigen::Matrix<double, plane_count, 1> strengths;  // Pa
};

/// The planes that a stress is returned to at once.
template <PlaneName... names>
struct Active {
    static constexpr int count = sizeof...(names);
    static constexpr std::array<int, sizeof...(names)> columns{names...};
};

struct PrincipalReturn {
    Vector3d stress = Vector3d::Zero();
    Vector3d plastic_strain = Vector3d::Zero();
    Matrix3d tangent = Matrix3d::Zero();
    YieldRegion region = YieldRegion::apex;
    double violation = std::numeric_limits<double>::infinity();  // largest plane function or negative multiplier, Pa
};

struct PrincipalProblem {
    Matrix3d stiffness;
    Vector3d trial;
    Planes planes;
    double shear_modulus;  // Pa
    double tolerance;      // Pa
    bool wants_tangent;
};

// The tip of the cone counts as a corner of the tension planes, which is where they are when nothing cuts it off: volumetric
// tension can then flow even at zero dilation.
double apex_stress(const MohrCoulomb& material) {
    if (material.sin_friction <= 0) return std::numeric_limits<double>::infinity();
    return material.cohesion * material.cos_friction / material.sin_friction;
}

Planes yield_planes(const MohrCoulomb& material, double tensile_strength) {
    const double up = 1 + material.sin_friction;
    const double down = material.sin_friction - 1;
    const double flow_up = 1 + material.sin_dilation;
    const double flow_down = material.sin_dilation - 1;
    const double shear_strength = 2 * material.cohesion * material.cos_friction;
    Planes planes;
    planes.normals << up, up, 0, 1, 0, 0, 0, down, up, 0, 1, 0, down, 0, down, 0, 0, 1;
    planes.flows << flow_up, flow_up, 0, 1, 0, 0, 0, flow_down, flow_up, 0, 1, 0, flow_down, 0, flow_down, 0, 0, 1;
    planes.strengths << Vector3d::Constant(shear_strength), Vector3d::Constant(tensile_strength);
    return planes;
}

// Returns by the given planes, keeps the result if it is the best so far, and says whether it is admissible. The second pass
// removes the round-off of the first, which grows with lame / shear towards incompressibility.
template <class These>
bool try_planes(const PrincipalProblem& problem, These, YieldRegion region, PrincipalReturn& best) {
    constexpr int n = These::count;
    const Planes& planes = problem.planes;
    const Eigen::Matrix<double, 3, n> normals = planes.normals(Eigen::all, These::columns);
    const Eigen::Matrix<double, 3, n> flows = planes.flows(Eigen::all, These::columns);
    const Eigen::Matrix<double, n, 1> strengths = planes.strengths(These::columns);
    const Eigen::Matrix<double, 3, n> stiff_flows = problem.stiffness * flows;
    const Eigen::Matrix<double, n, n> compliance = (normals.transpose() * stiff_flows).eval().inverse();
    Eigen::Matrix<double, n, 1> multipliers = Eigen::Matrix<double, n, 1>::Zero();
    Vector3d stress = problem.trial;
    for (int pass = 0; pass < 2; ++pass) {
        const Eigen::Matrix<double, n, 1> correction = compliance * (normals.transpose() * stress - strengths);
        multipliers += correction;
        stress -= stiff_flows * correction;
    }

    const double violation = std::max(-multipliers.minCoeff() * problem.shear_modulus,
                                      (planes.normals.transpose() * stress - planes.strengths).maxCoeff());
    if (!(violation < best.violation)) return false;

    best.stress = stress;
    best.plastic_strain = flows * multipliers;
    if (problem.wants_tangent)
        best.tangent = problem.stiffness - stiff_flows * compliance * normals.transpose() * problem.stiffness;
    best.region = region;
    best.violation = violation;
    return violation <= problem.tolerance;
}

/// Says cheaply which planes cannot be the answer: a_j . D b_k of all planes and f of the trial stress, found once, tell the multipliers
/// of any of them and what is left of the others' f.
class Screen {
public:
    explicit Screen(const PrincipalProblem& problem)
        : problem_(problem),
          relief_(problem.planes.normals.transpose() * (problem.stiffness * problem.planes.flows)),
          excess_(problem.planes.normals.transpose() * problem.trial - problem.planes.strengths) {}

    template <class These>
    [[nodiscard]] bool lets_pass(These) const {
        constexpr double round_off = 1e6;  // many times the tolerance, for what try_planes() removes in its second pass
        constexpr int n = These::count;
        const Eigen::Matrix<double, plane_count, n> relief = relief_(Eigen::all, These::columns);
        const Eigen::Matrix<double, n, n> active = relief(These::columns, Eigen::all);
        const Eigen::Matrix<double, n, 1> multipliers = active.inverse() * excess_(These::columns);
        const double most = round_off * problem_.tolerance;
        return -multipliers.minCoeff() * problem_.shear_modulus <= most &&
               (excess_ - relief * multipliers).maxCoeff() <= most;
    }

private:
    const PrincipalProblem& problem_;
    Eigen::Matrix<double, plane_count, plane_count> relief_;  // Pa
    Eigen::Matrix<double, plane_count, 1> excess_;            // Pa
};

// From the most frequent to the rarest, after the main plane, until one is admissible.
template <class Attempt>
bool try_edges_and_corners(bool is_cut_off, bool has_tip, Attempt&& attempt) {
    const YieldRegion tension = is_cut_off ? YieldRegion::tension : YieldRegion::apex;
    const YieldRegion shear_tension = is_cut_off ? YieldRegion::shear_tension : YieldRegion::apex;
    if (attempt(Active<shear_13, shear_12>{}, YieldRegion::shear_edge)) return true;
    if (attempt(Active<shear_13, shear_23>{}, YieldRegion::shear_edge)) return true;
    if (!has_tip) return false;
    return attempt(Active<tension_1, tension_2, tension_3>{}, YieldRegion::apex) ||
           attempt(Active<tension_1>{}, tension) || attempt(Active<tension_1, tension_2>{}, tension) ||
           attempt(Active<shear_13, tension_1>{}, shear_tension) ||
           attempt(Active<shear_13, shear_12, tension_1>{}, shear_tension) ||
           attempt(Active<shear_13, tension_1, tension_2>{}, shear_tension) ||
           attempt(Active<shear_13, shear_23, tension_2>{}, shear_tension);
}

// Were round-off to leave none admissible, the least violated stands.
PrincipalReturn return_principal(const Elasticity& elastic, const MohrCoulomb& material, const Vector3d& trial,
                                 bool wants_tangent) {
    const double apex = apex_stress(material);
    const bool is_cut_off = material.tensile_strength < apex;
    const double tensile_strength = is_cut_off ? material.tensile_strength : apex;
    const bool has_tip = std::isfinite(tensile_strength);
    const PrincipalProblem problem{elastic_stiffness(elastic).topLeftCorner<3, 3>(),
                                   trial,
                                   yield_planes(material, tensile_strength),
                                   elastic.shear,
                                   1e-12 * trial.cwiseAbs().maxCoeff(),
                                   wants_tangent};
    PrincipalReturn best;
    if (try_planes(problem, Active<shear_13>{}, YieldRegion::shear, best)) return best;
    const Screen screen(problem);
    const auto likely = [&](auto planes, YieldRegion region) {
        return screen.lets_pass(planes) && try_planes(problem, planes, region, best);
    };
    const auto any = [&](auto planes, YieldRegion region) { return try_planes(problem, planes, region, best); };
    if (!try_edges_and_corners(is_cut_off, has_tip, likely)) try_edges_and_corners(is_cut_off, has_tip, any);
    return best;
}

// The principal directions of a plane-strain stress, and where each principal stress stands when they are sorted.
struct PrincipalFrame {
    Vector3d stress;                    // sorted, largest first
    Eigen::Matrix<double, 4, 3> dyads;  // n_i x n_i as (xx, yy, zz, xy), columns sorted as the stress
    Vector4d spin;  // n_major x n_minor, made symmetric: shear strain between the in-plane directions
    int major;      // of the two in-plane stresses
    int minor;
};

PrincipalFrame principal_frame(const Vector4d& stress) {
    const double centre = (stress[0] + stress[1]) / 2;
    const double half_difference = (stress[0] - stress[1]) / 2;
    const double radius = std::sqrt(half_difference * half_difference + stress[3] * stress[3]);
    const double cosine = radius > 0 ? half_difference / radius : 1;  // of twice the angle of the major direction
    const double sine = radius > 0 ? stress[3] / radius : 0;

    PrincipalFrame frame;
    frame.major = stress[2] > centre + radius ? 1 : 0;
    frame.minor = stress[2] < centre - radius ? 1 : 2;
    const int out_of_plane = 3 - frame.major - frame.minor;
    frame.stress[frame.major] = centre + radius;
    frame.stress[frame.minor] = centre - radius;
    frame.stress[out_of_plane] = stress[2];
    frame.dyads.col(frame.major) << (1 + cosine) / 2, (1 - cosine) / 2, 0, sine / 2;
    frame.dyads.col(frame.minor) << (1 - cosine) / 2, (1 + cosine) / 2, 0, -sine / 2;
    frame.dyads.col(out_of_plane) << 0, 0, 1, 0;
    frame.spin << -sine, sine, 0, cosine;
    return frame;
}

// Shear stress that follows a unit shear strain between the in-plane principal directions, over the elastic one: the returned
// difference of the two stresses over the trial one, or its limit, from the tangent, where the two are equal.
double spin_ratio(const PrincipalFrame& frame, const PrincipalReturn& principal, double shear_modulus) {
    const int i = frame.major;
    const int j = frame.minor;
    const double trial_difference = frame.stress[i] - frame.stress[j];
    if (trial_difference > 1e-8 * frame.stress.cwiseAbs().maxCoeff())
        return (principal.stress[i] - principal.stress[j]) / trial_difference;
    const Matrix3d& tangent = principal.tangent;
    return (tangent(i, i) - tangent(i, j) - tangent(j, i) + tangent(j, j)) / (4 * shear_modulus);
}

}  // namespace

MohrCoulomb mohr_coulomb(const ShearStrength& strength, double dilation_angle, double tensile_strength) {
    constexpr double radians = std::numbers::pi / 180;
    const double friction = strength.friction_angle * radians;
    const double sin_friction = std::sin(friction);
    return {strength.cohesion, sin_friction, std::cos(friction),
            std::min(std::sin(dilation_angle * radians), sin_friction), tensile_strength};
}

PlasticReturn return_to_yield_surface(const Elasticity& elastic, const MohrCoulomb& material, const Vector4d& trial,
                                      Matrix4d* tangent) {
    const PrincipalFrame frame = principal_frame(trial);
    const PrincipalReturn principal = return_principal(elastic, material, frame.stress, tangent != nullptr);
    if (tangent != nullptr) {
        *tangent = frame.dyads * principal.tangent * frame.dyads.transpose() +
                   elastic.shear * spin_ratio(frame, principal, elastic.shear) * frame.spin * frame.spin.transpose();
    }

    PlasticReturn result;
    result.stress = frame.dyads * principal.stress;
    result.plastic_strain = frame.dyads * principal.plastic_strain;
    result.plastic_strain[3] *= 2;  // the angle, not the tensor component
    const Vector3d deviator = principal.plastic_strain.array() - principal.plastic_strain.mean();
    result.plastic_shear_strain = std::sqrt(2.0 / 3.0 * deviator.squaredNorm());
    result.region = principal.region;
    return result;
}

}  // namespace talus

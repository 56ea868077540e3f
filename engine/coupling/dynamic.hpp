// The macro step of a dynamic ground: its material points carried through a host's step by their momentum.
#pragma once

#include "coupling/ground_state.hpp"
#include "coupling/handover.hpp"
#include "coupling/motion_report.hpp"
#include "coupling/progress.hpp"
#include "ground/mesh.hpp"
#include "points/points.hpp"
#include "scene/scene.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace talus {

/// Rain at each x (m): a volume per horizontal area, m/s.
using RainAt = std::function<double(double x)>;

/// Water that went in and out of the ground in the last advance, m3 per metre of thickness.
struct WaterExchange {
    double rain = 0;
    double run_off = 0;
    double seepage = 0;   ///< what evaporated included
    double absorbed = 0;  ///< of points taken out at the ends of the background
};

/// Ground that came to an end of the background.
struct EndReached {
    double time;      ///< s, when it was first seen
    Place place;      ///< where, m
    double absorbed;  ///< taken out, m3 per metre of thickness
};

class DynamicGround {
public:
    /// As make_motion().
    DynamicGround(const Scene& scene, const Mesh& mesh, const Points& mesh_points, const Handover& handover,
                  int32_t threads);

    /// Carries the points from one time to another, s, or until they rest. False when `cancelled` said so. Throws Error(not_converged) where the motion
    /// comes to no number, the ground is pressed to less than its grains or it spreads beyond all bounds. In both cases the caller puts the points back.
    bool advance(double from, double until, const RainAt& rain, const Cancelled& cancelled);

    [[nodiscard]] MovingState save() const { return {points(), absorbed_, watch_, has_come_to_end_}; }
    void restore(const MovingState& state);  ///< as it was, to the last bit

    [[nodiscard]] double time() const { return time_; }  ///< that the last advance came to, s
    /// Whether the last advance ended because the kinetic energy had been below a thousandth of its peak for a second, or no point had come further by a
    /// tenth of a cell's size h within 30 sqrt(h / g).
    [[nodiscard]] bool rests() const { return rests_; }
    /// In the last advance: the first time in this motion, and whenever points were taken out.
    [[nodiscard]] const std::optional<EndReached>& end_reached() const { return end_reached_; }
    [[nodiscard]] double rain_on(const RainAt& rain) const;  ///< m3/s, on the columns of the grid that hold ground

    [[nodiscard]] const FreePoints& points() const;
    [[nodiscard]] double cell_size() const;
    [[nodiscard]] const Walls& walls() const;
    [[nodiscard]] bool has_water() const { return !std::holds_alternative<ExplicitMotion>(motion_); }
    [[nodiscard]] bool has_gas() const {
        return std::holds_alternative<ThreePhases>(motion_) || has_exchange();
    }  ///< that moves
    [[nodiscard]] bool has_exchange() const {
        return std::holds_alternative<Exchange>(motion_);
    }  ///< between the fluids
    // Of a point, where there is water; Pa, -.
    [[nodiscard]] double pressure(size_t point) const;
    [[nodiscard]] double gas_pressure(size_t point) const;  ///< 0: at rest
    [[nodiscard]] double saturation(size_t point) const;
    [[nodiscard]] double relative_humidity(size_t point) const;  ///< with exchange
    [[nodiscard]] double dissolved_air(size_t point) const;      ///< kg per m3 of water; likewise
    [[nodiscard]] double pore_stress(size_t point) const;
    /// In the ground, m3 per metre of thickness; 0: dry. With exchange the liquid of the start, and the water that came and went since as liquid
    /// or vapour.
    [[nodiscard]] double water() const;
    [[nodiscard]] const WaterExchange& water_exchange() const { return water_exchange_; }
    [[nodiscard]] double porosity(size_t point) const;
    [[nodiscard]] double lost_strength(size_t point) const;  ///< share of what softening takes, 0 to 1
    [[nodiscard]] MotionReport report() const;

    /// Of all points that there ever were, by their numbers. A point that was taken out stays where it left.
    [[nodiscard]] size_t numbers() const { return start_position_.size() / 2; }
    [[nodiscard]] const std::vector<double>& start_position() const { return start_position_; }  ///< x, y, m
    [[nodiscard]] std::vector<double> positions() const;                                         ///< likewise
    /// Share of the shear strength in use by a point, 0 to 1.
    [[nodiscard]] double mobilised_strength(size_t point) const;

private:
    /// query(mixture) of ground with water, else nothing.
    template <class Query>
    auto of_mixture(const Query& query) const;
    [[nodiscard]] WaterExchange exchanged_water() const;  // since the motion was begun anew
    template <class Moving>
    bool move(Moving& motion, double from, double until, const Cancelled& cancelled);
    template <class Moving>
    void look(const Moving& motion, double time);
    template <class Moving>
    void look_for_ends(Moving& motion, double time);
    template <class Moving>
    void absorb(Moving& motion, const std::vector<int32_t>& leaving);
    void start_window(double time);
    [[nodiscard]] double come_in_window() const;  // m, of the point that has come farthest
    [[nodiscard]] double solutes() const;         // kg, of air in the water less vapour
    void report_slide(const std::vector<double>& position, const std::vector<double>& volume,
                      MotionReport& report) const;
    void check_numbers() const;
    void check_pores(double time) const;

    std::vector<ExplicitSoil> soils_;
    Motion motion_;
    double water_density_ = 0;           // kg/m3
    double start_solutes_ = 0;           // kg, of air in the water less vapour, at the start
    std::vector<double> grain_density_;  // per soil, kg/m3
    std::vector<double> start_position_;
    bool may_rest_ = false;  // whether the motion ends where it rests
    double window_ = 0;      // s, in which ground that rests comes no further
    bool rests_ = false;
    double time_ = 0;  // s
    RestWatch watch_;
    Dynamics dynamics_;
    AbsorbedPoints absorbed_;
    bool has_come_to_end_ = false;
    std::optional<EndReached> end_reached_;  // of the last advance
    WaterExchange water_exchange_;           // likewise
    double start_energy_ = 0;                // J
    int64_t substeps_ = 0;                   // of the last advance
    double peak_velocity_ = 0;               // m/s, likewise
};

}  // namespace talus

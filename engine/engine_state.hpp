// What stands behind the facade. Private to engine/engine*.cpp.
#pragma once

#include "background/locate.hpp"
#include "background/nearest.hpp"
#include "coupling/simulation.hpp"
#include "engine.hpp"

#include <atomic>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace talus {

/// A probe stays with the ground: it is a place in a cell, or a material point, not a place in space.
struct ProbeTrack {
    std::string name;
    Place place;                               ///< where it was put, m
    Place start;                               ///< where the ground there lay at the start, m
    CellPlace cell_place;                      ///< of a quasi-static ground
    int32_t point = -1;                        ///< of a dynamic one: the nearest to the place
    std::vector<std::vector<double>> history;  ///< one a quantity, one value a row of Engine::State::probe_times
};

/// Where ground settled within a step.
struct Replaced {
    std::unique_ptr<Simulation> first;  ///< that the step began with; empty: it is the present one
    MotionReport motion;                ///< of the last motion
};

struct Engine::State {
    State(std::shared_ptr<const Scene> scene_in, Options options_in);

    std::shared_ptr<const Scene> scene;
    Options options;
    std::unique_ptr<Simulation> simulation;
    Locator locator;  ///< of the ground as it lay at the start, or as it settled
    std::atomic<double> time{0.0};
    std::atomic<bool> cancel_asked{false};
    int64_t epoch = 1;
    StepReport report;
    std::vector<Event> events;
    std::vector<double> probe_times;
    std::vector<std::string> quantities;  ///< what probes record: scalars, or field.component
    std::vector<ProbeTrack> probes;
    std::string description;

    /// Fields that are made from others, when they are asked for; of the present epoch.
    mutable std::map<std::string, std::vector<double>, std::less<>> derived;
    mutable std::unique_ptr<NearestPlace> nearest;  ///< of a dynamic ground's points, of the present epoch
    std::vector<int32_t> point_soil;                ///< of a dynamic ground, by the points' numbers

    /// Carries the simulation to `until`, or to where it stops at a motion; false when cancelled.
    bool advance(double until, const Cancelled& cancelled, Replaced& replaced);

    // engine_fields.cpp
    [[nodiscard]] std::vector<std::string> field_names() const;
    [[nodiscard]] FieldView view(std::string_view field) const;
    /// The field's values at a place, one a component. False: it lies outside the ground.
    bool sample(const FieldView& field, double x, double y, std::span<double> values) const;
    void sample_cell(const FieldView& field, const CellPlace& place, std::span<double> values) const;
    [[nodiscard]] std::vector<std::string> probe_quantities() const;
    void record_probes();
    void record(ProbeTrack& probe) const;
    void record_row(const ProbeTrack& probe, std::string_view name, std::span<double> row) const;
    /// A probe without a history yet; it has neither cell nor point where the place lies outside the ground.
    [[nodiscard]] ProbeTrack make_probe(const std::string& name, Place place) const;
    /// A ground has come to be one of another mesh: probes go on where what lay at their places at the start lies now.
    void follow_mesh();

    // engine_dynamic_fields.cpp
    void number_point_soils();
    /// A ground of a mesh has come to be one of points: probes go on with the points nearest to them.
    void follow_points();
    [[nodiscard]] std::vector<std::string> point_field_names() const;
    [[nodiscard]] bool has_point_field(std::string_view name) const;
    [[nodiscard]] std::vector<std::string> point_quantities() const;
    [[nodiscard]] FieldView view_points(std::string_view field) const;
    /// The number of the nearest point within a cell's size, -1 where there is none.
    [[nodiscard]] int32_t nearest_point(double x, double y) const;
    static void copy_row(const FieldView& field, int32_t point, std::span<double> values);
    void report_motion();

    // engine_describe.cpp
    [[nodiscard]] std::string describe() const;

    void report_water(WaterBalance& water) const;
    void tell_happenings();
};

/// Bytes held in the arrays of a field list; used by describe().
int64_t bytes_held(const Simulation& simulation);

}  // namespace talus

#include "coupling/dynamic.hpp"

#include "coupling/background.hpp"
#include "error.hpp"
#include "scene/problems.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace talus {
namespace {

constexpr int64_t substeps_a_look = 16;
constexpr double rest_share = 1e-3;  // of the largest kinetic energy of the motion: below it for
constexpr double rest_time = 1;      // s, the ground rests;
constexpr double window_falls = 30;  // or where within so many times sqrt(h / g), about that of a fall through a cell,
constexpr double rest_come = 0.1;    // no point has come further by so much of the cell: elastic ground rings on
constexpr double most_nodes = 2e7;   // of the grid: 1.3 GB

double sum(const Energies& energies) { return energies.kinetic + energies.elastic + energies.potential; }

double held(const FreePoints& points, PointField mass, PointField due) {
    double sum = 0;
    for (size_t p = 0; p < points.count; ++p) sum += points[mass][p] + points[due][p];
    return sum;
}

double largest_speed(const FreePoints& points) {
    double largest = 0;
    for (size_t p = 0; p < points.count; ++p)
        largest = std::max(largest, std::hypot(points[velocity_x][p], points[velocity_y][p]));
    return largest;
}

/// Whether all of a field are numbers: the sum of finite values is one, below what ground can have.
bool is_finite(const FreePoints& points, PointField name) {
    double total = 0;
    for (size_t p = 0; p < points.count; ++p) total += points[name][p];
    return std::isfinite(total);
}

[[noreturn]] void stop(double time, const std::string& problem) {
    throw Error(Status::not_converged,
                "t = " + value_text(time) + " s: " + problem + "; this says nothing about the slope");
}

}  // namespace

DynamicGround::DynamicGround(const Scene& scene, const Mesh& mesh, const Points& mesh_points, const Handover& handover,
                             int32_t threads)
    : soils_(explicit_soils(scene)),
      motion_(make_motion(scene, mesh, mesh_points, handover, threads)),
      water_density_(scene.water.density),
      may_rest_(scene.physics.regime == MotionRegime::automatic),
      dynamics_(scene.dynamics) {
    start_solutes_ = solutes();
    start_energy_ = std::visit([](const auto& motion) { return sum(motion.energies()); }, motion_);
    for (const Soil& soil : scene.soils) grain_density_.push_back(soil.dry_density / (1 - soil.porosity));
    start_position_.resize(2 * points().count);
    start_position_ = positions();
    window_ = window_falls * std::sqrt(cell_size() / scene.gravity);
    watch_.moved_last = handover.time;
    if (may_rest_) start_window(handover.time);
    if (!handover.displacement.empty()) subtract_displacement(mesh, handover.displacement, points(), start_position_);
}

// The macro step of a dynamic ground: substeps of equal length, as long as the fastest wave and the fastest motion allow.
bool DynamicGround::advance(double from, double until, const RainAt& rain, const Cancelled& cancelled) {
    substeps_ = 0;
    peak_velocity_ = 0;
    rests_ = false;
    end_reached_.reset();
    water_exchange_ = {};
    if (points().count == 0) {  // all were taken out
        rests_ = may_rest_;
        time_ = until;
        return true;
    }
    std::visit([](auto& motion) { motion.restart(); }, motion_);  // what follows depends on the points alone
    return std::visit(
        [&](auto& motion) {
            if constexpr (requires { motion.set_rain(rain); }) motion.set_rain(rain);
            return move(motion, from, until, cancelled);
        },
        motion_);
}

template <class Moving>
bool DynamicGround::move(Moving& motion, double from, double until, const Cancelled& cancelled) {
    double time = from;
    while (time < until) {
        const double left = until - time;
        const double count = std::ceil(left / motion.critical_step());
        const bool is_last = count <= 1;
        const double next = is_last ? until : time + left / count;
        if (!(next > time)) stop(time, "the motion became too fast to be followed");
        const bool looks = is_last || substeps_ % substeps_a_look == substeps_a_look - 1;
        if (!motion.step(next - time, looks))
            stop(next, "ground moved across several cells in a substep, or its velocity came to no number");
        ++substeps_;
        time = next;
        if (!looks) continue;
        look(motion, time);
        look_for_ends(motion, time);
        if (points().count == 0) time = until;
        if (cancelled((time - from) / (until - from))) return false;
        if (rests_) break;
    }
    time_ = time;
    check_numbers();
    const WaterExchange through_surface = exchanged_water();
    water_exchange_ = {through_surface.rain, through_surface.run_off, through_surface.seepage,
                       water_exchange_.absorbed};
    return true;
}

/// Of the last substep: another one would not do with what is no number.
void DynamicGround::check_numbers() const {
    for (const PointField name :
         {position_x, position_y, velocity_x, velocity_y, stress_xx, stress_yy, stress_zz, stress_xy, point_volume}) {
        if (!is_finite(points(), name)) stop(time_, "the state of the ground came to no number");
    }
}

template <class Moving>
void DynamicGround::look(const Moving& motion, double time) {
    const FreePoints& points = motion.points();
    check_pores(time);
    if (static_cast<double>(motion.grid().nodes()) > most_nodes) {
        stop(time, "the ground spread over more than " + value_text(most_nodes) +
                       " cells; dynamics.xFrom, xTo, yFrom and yTo end the background");
    }
    peak_velocity_ = std::max(peak_velocity_, largest_speed(points));
    if (!may_rest_) return;
    const double kinetic = motion.energies().kinetic;
    watch_.peak_energy = std::max(watch_.peak_energy, kinetic);
    if (kinetic > rest_share * watch_.peak_energy) watch_.moved_last = time;
    rests_ = time - watch_.moved_last >= rest_time;
    if (time - watch_.window_start < window_) return;
    rests_ = rests_ || come_in_window() < rest_come * cell_size();
    start_window(time);
}

/// What has come to an end of the background is told the first time, and taken out where the scene says so.
template <class Moving>
void DynamicGround::look_for_ends(Moving& motion, double time) {
    const std::vector<int32_t> found = points_at_ends(dynamics_, points(), cell_size());
    const bool absorbs = dynamics_.at_ends == EndPolicy::absorb;
    if (found.empty() || (has_come_to_end_ && !absorbs)) return;
    const auto first = static_cast<size_t>(found.front());
    const Place place{points()[position_x][first], points()[position_y][first]};
    if (!end_reached_) end_reached_ = EndReached{time, place, 0};
    has_come_to_end_ = true;
    if (absorbs) absorb(motion, found);
}

template <class Moving>
void DynamicGround::absorb(Moving& motion, const std::vector<int32_t>& leaving) {
    const FreePoints& points = motion.points();
    std::vector<int32_t> staying;
    auto next = leaving.begin();
    for (size_t p = 0; p < points.count; ++p) {
        if (next == leaving.end() || *next != static_cast<int32_t>(p)) {
            staying.push_back(static_cast<int32_t>(p));
            continue;
        }
        ++next;
        absorbed_.number.push_back(points.number[p]);
        absorbed_.position.insert(absorbed_.position.end(), {points[position_x][p], points[position_y][p]});
        absorbed_.volume.push_back(points[point_volume][p]);
        end_reached_->absorbed += points[point_volume][p];
    }
    const double energy_before = sum(motion.energies()), water_before = water();
    motion.keep(staying);
    absorbed_.energy += energy_before - sum(motion.energies());
    water_exchange_.absorbed += water_before - water();
}

void DynamicGround::start_window(double time) {
    watch_.window_start = time;
    watch_.window_position = positions();
}

double DynamicGround::come_in_window() const {
    const FreePoints& points = this->points();
    double farthest = 0;
    for (size_t p = 0; p < points.count; ++p) {
        const double* start = &watch_.window_position[2 * static_cast<size_t>(points.number[p])];
        farthest = std::max(farthest, std::hypot(points[position_x][p] - start[0], points[position_y][p] - start[1]));
    }
    return farthest;
}

void DynamicGround::restore(const MovingState& state) {
    absorbed_ = state.absorbed;
    watch_ = state.rest_watch;
    has_come_to_end_ = state.has_come_to_end;
    std::visit([&](auto& motion) { motion.points() = state.points; }, motion_);
}

std::vector<double> DynamicGround::positions() const {
    std::vector<double> position(start_position_.size());
    const auto put = [&](int32_t number, double x, double y) {
        position[2 * static_cast<size_t>(number)] = x;
        position[2 * static_cast<size_t>(number) + 1] = y;
    };
    const FreePoints& points = this->points();
    for (size_t p = 0; p < points.count; ++p) put(points.number[p], points[position_x][p], points[position_y][p]);
    for (size_t k = 0; k < absorbed_.number.size(); ++k)
        put(absorbed_.number[k], absorbed_.position[2 * k], absorbed_.position[2 * k + 1]);
    return position;
}

const FreePoints& DynamicGround::points() const {
    return std::visit([](const auto& motion) -> const FreePoints& { return motion.points(); }, motion_);
}

double DynamicGround::cell_size() const {
    return std::visit([](const auto& motion) { return motion.grid().cell_size; }, motion_);
}

const Walls& DynamicGround::walls() const {
    return std::visit([](const auto& motion) -> const Walls& { return motion.walls(); }, motion_);
}

double DynamicGround::rain_on(const RainAt& rain) const {
    const Grid& grid = std::visit([](const auto& motion) -> const Grid& { return motion.grid(); }, motion_);
    std::vector<uint8_t> held(static_cast<size_t>(grid.cells[0]), 0);
    for (size_t p = 0; p < points().count; ++p) held[static_cast<size_t>(grid.cell_of(points()[position_x][p], 0))] = 1;
    double sum = 0;
    for (size_t column = 0; column < held.size(); ++column) {
        if (held[column] == 0) continue;
        sum += grid.cell_size * rain(grid.corner[0] + (static_cast<double>(column) + 0.5) * grid.cell_size);
    }
    return sum;
}

template <class Query>
auto DynamicGround::of_mixture(const Query& query) const {
    return std::visit(
        [&](const auto& motion) {
            using Result = decltype(query(std::declval<const Mixture&>()));
            if constexpr (requires { motion.rained(); }) {
                return query(motion);
            } else {
                return Result{};
            }
        },
        motion_);
}

double DynamicGround::pressure(size_t point) const {
    return of_mixture([&](const auto& mixture) { return mixture.pressure(point); });
}

double DynamicGround::gas_pressure(size_t point) const {
    return of_mixture([&](const auto& mixture) { return mixture.gas_pressure(point); });
}

double DynamicGround::saturation(size_t point) const {
    return of_mixture([&](const auto& mixture) { return mixture.saturation(point); });
}

double DynamicGround::relative_humidity(size_t point) const {
    return has_exchange() ? std::get<Exchange>(motion_).relative_humidity(point) : 0;
}

double DynamicGround::dissolved_air(size_t point) const {
    return has_exchange() ? std::get<Exchange>(motion_).dissolved_air(point) : 0;
}

double DynamicGround::pore_stress(size_t point) const {
    return of_mixture([&](const auto& mixture) { return mixture.pore_stress(point); });
}

double DynamicGround::water() const {
    if (!has_water()) return 0;
    return (held(points(), water_mass, water_due) - solutes() + start_solutes_) / water_density_;
}

double DynamicGround::solutes() const {
    if (!has_exchange()) return 0;
    return held(points(), dissolved_mass, dissolved_due) - held(points(), vapour_mass, vapour_due);
}

double DynamicGround::porosity(size_t point) const {
    const double grains = grain_density_[static_cast<size_t>(points().soil[point])] * points()[point_volume][point];
    return 1 - points()[solid_mass][point] / grains;
}

double DynamicGround::lost_strength(size_t point) const {
    const ExplicitSoil& soil = soils_[static_cast<size_t>(points().soil[point])];
    if (soil.softening_slip <= 0) return 0;
    return share_lost(soil, points()[plastic_shear_strain][point], cell_size());
}

WaterExchange DynamicGround::exchanged_water() const {
    return of_mixture([this](const auto& mixture) {
        const auto volume = [this](double mass) { return mass / water_density_; };
        return WaterExchange{volume(mixture.rained()), volume(mixture.run_off()),
                             volume(mixture.seepage() + mixture.evaporated()), 0};
    });
}

/// Grains keep their volume: no ground is denser than they are.
void DynamicGround::check_pores(double time) const {
    const FreePoints& points = this->points();
    for (size_t p = 0; p < points.count; ++p) {
        const double grains = grain_density_[static_cast<size_t>(points.soil[p])] * points[point_volume][p];
        if (points[solid_mass][p] <= grains) continue;
        stop(time, "at (" + value_text(points[position_x][p]) + ", " + value_text(points[position_y][p]) +
                       ") m the ground is pressed to less than the volume of its grains, too soft for what it bears");
    }
}

MotionReport DynamicGround::report() const {
    const FreePoints& points = this->points();
    MotionReport report;
    report.substeps = substeps_;
    const Energies energies = std::visit([](const auto& motion) { return motion.energies(); }, motion_);
    report.kinetic_energy = energies.kinetic;
    report.elastic_energy = energies.elastic;
    report.potential_energy = energies.potential;
    report.dissipated_energy = start_energy_ - absorbed_.energy - sum(energies);
    report.largest_velocity = largest_speed(points);
    report.peak_velocity = std::max(peak_velocity_, report.largest_velocity);
    std::vector<double> volume(numbers(), 0.0);
    for (size_t p = 0; p < points.count; ++p) volume[static_cast<size_t>(points.number[p])] = points[point_volume][p];
    for (size_t k = 0; k < absorbed_.number.size(); ++k)
        volume[static_cast<size_t>(absorbed_.number[k])] = absorbed_.volume[k];
    report_slide(positions(), volume, report);
    return report;
}

/// Of all points that there ever were, by their numbers; one that was taken out slides as far as the end.
void DynamicGround::report_slide(const std::vector<double>& position, const std::vector<double>& volume,
                                 MotionReport& report) const {
    double advance = 0;  // m3 m: of the sliding volume along x
    std::vector<size_t> sliding;
    for (size_t number = 0; number < volume.size(); ++number) {
        const double* start = &start_position_[2 * number];
        const double along = position[2 * number] - start[0];
        const double displacement = std::hypot(along, position[2 * number + 1] - start[1]);
        report.largest_displacement = std::max(report.largest_displacement, displacement);
        if (displacement <= cell_size()) continue;
        sliding.push_back(number);
        report.sliding_volume += volume[number];
        advance += volume[number] * along;
    }
    if (sliding.empty()) return;
    const double forwards = advance < 0 ? -1 : 1;
    double front = -std::numeric_limits<double>::infinity(), start_front = front;
    for (const size_t number : sliding) {
        front = std::max(front, forwards * position[2 * number]);
        start_front = std::max(start_front, forwards * start_position_[2 * number]);
    }
    report.front_x = forwards * front;
    report.run_out = front - start_front;
}

double DynamicGround::mobilised_strength(size_t point) const {
    const FreePoints& points = this->points();
    if (!soils_[static_cast<size_t>(points.soil[point])].yields) return 0;
    const MohrCoulomb material = std::visit([point](const auto& motion) { return motion.strength(point); }, motion_);
    return talus::mobilised_strength(material, {points[stress_xx][point], points[stress_yy][point],
                                                points[stress_zz][point], points[stress_xy][point]});
}

}  // namespace talus

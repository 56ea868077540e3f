// Scenes from JSON text and Cap'n Proto bytes, and back.
#include "error.hpp"
#include "scene/read.hpp"
#include "unit/scene_files.hpp"

#include <doctest/doctest.h>
#include <unistd.h>
#include <clocale>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

namespace {

using namespace talus;
using nlohmann::json;

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr const char* samples[] = {"column", "column_constant_k", "slope", "slope_failure", "slope_gentle"};

Scene one_soil(const std::string& soil) { return read_json(R"({"soils": [)" + soil + "]}"); }

Retention retention(const std::string& model) {
    return one_soil(R"({"hydraulics": {"retention": {"model": ")" + model + R"("}}})").soils[0].hydraulics.retention;
}

RelativePermeability permeability(const std::string& model) {
    const std::string text = R"({"hydraulics": {"relativePermeability": {"model": ")" + model + R"("}}})";
    return one_soil(text).soils[0].hydraulics.relative_permeability;
}

Boundary boundary(const std::string& fields) {
    return read_json(R"({"boundaries": [{)" + fields + "}]}").boundaries[0];
}

TEST_CASE("the column is read as it is written") {
    const Scene scene = read_json(sample_text("column"));
    CHECK(scene.name == "column");
    CHECK_FALSE(scene.physics.deforming);
    CHECK(scene.physics.water);
    REQUIRE(scene.soils.size() == 1);
    const Soil& soil = scene.soils[0];
    CHECK(soil.name == "soil");
    CHECK(soil.porosity == 0.4);
    CHECK(std::isnan(soil.dry_density));
    CHECK(soil.hydraulics.retention.alpha == 4e-5);
    CHECK(soil.hydraulics.retention.n == 1.2);
    CHECK(soil.hydraulics.relative_permeability.pore_connectivity == 0.5);
    CHECK(soil.hydraulics.conductivity.along == 1e-4);
    CHECK(soil.hydraulics.conductivity.across == 1e-4);  // left out: as along
    CHECK(scene.ground.kind == GroundKind::column);
    CHECK(scene.ground.column.cells == 100);
    CHECK(scene.ground.column.height == 1);
    CHECK(scene.surface.zones[0].rate == std::vector<double>{1e-4});
    CHECK(std::isnan(scene.surface.zones[0].rain_end));
    CHECK(scene.initial.flow == InitialFlow::saturation);
    CHECK(scene.initial.saturation == 0.85);
    CHECK(scene.schedule.outputs == std::vector<double>{20, 80, 160, 320, 600});
    CHECK(scene.probes[1].place == Place{0, 0.5});
}

TEST_CASE("the slope is read as it is written") {
    const Scene scene = read_json(sample_text("slope"));
    const SectionGround& section = scene.ground.section;
    CHECK(scene.ground.kind == GroundKind::section);
    CHECK(section.terrain == std::vector<Place>{{0, 30}, {20, 30}, {40, 10}, {60, 10}});
    CHECK(section.base == std::vector<Place>{{0, 0}, {60, 0}});
    CHECK(section.layers.size() == 1);
    CHECK(section.layers[0].top.empty());
    CHECK(scene.soils[0].dry_density == 1800);
    CHECK(scene.soils[0].solid.model == SolidModel::mohr_coulomb);
    CHECK(scene.soils[0].solid.strength.model == StrengthModel::vanapalli);
    CHECK(scene.soils[0].solid.strength.cohesion == 12000);
    CHECK(scene.soils[0].solid.strength.friction_angle == 30);
    CHECK(scene.soils[0].solid.tensile_strength == infinite);
    REQUIRE(scene.boundaries.size() == 5);
    const Boundary& water = scene.boundaries[3];
    CHECK(water.side == "left");
    CHECK(water.has_flow);
    CHECK_FALSE(water.has_motion);
    CHECK(water.flow == FlowCondition::hydrostatic);
    CHECK(water.flow_value.time == std::vector<double>{0});  // left out where there is one value
    CHECK(water.flow_value.value == std::vector<double>{8});
    CHECK(water.y_to == 8);
    CHECK(water.y_from == -infinite);
    CHECK(scene.initial.surface_pressure == -1e5);
    CHECK(scene.surface.zones[0].rate[0] == doctest::Approx(0.012 / 3600).epsilon(1e-15));
    CHECK(scene.schedule.duration == 36 * 3600);
}

TEST_CASE("JSON and bytes lead back to the same scene") {
    const json table = json::parse(file_text("tests/robustness/wrong_scenes.json"));
    std::vector<std::string> texts;
    for (const char* name : samples) texts.push_back(sample_text(name));
    for (const json& scene : table["scenes"]) texts.push_back(scene.dump());
    for (const std::string& text : texts) {
        const Scene scene = read_json(text);
        const std::string written = write_json(scene);
        CHECK(write_json(read_json(written)) == written);
        CHECK(write_json(read_bytes(write_bytes(scene))) == written);
        CHECK(write_bytes(read_json(written)) == write_bytes(scene));
    }
}

TEST_CASE("numbers keep all their digits") {
    Scene scene;
    for (const double value : {0.1, 1.0 / 3, 4e-5, 1e-300, 5e-324, 1.7976931348623157e308, -0.0, 129600.00000000001}) {
        scene.schedule.outputs.push_back(value);
    }
    CHECK(read_json(write_json(scene)).schedule.outputs == scene.schedule.outputs);
    CHECK(read_bytes(write_bytes(scene)).schedule.outputs == scene.schedule.outputs);
}

TEST_CASE("the schema has the defaults of the structs") {
    const auto has_a_value = [](const json& written) {
        const json flat = written.flatten();
        return std::any_of(flat.begin(), flat.end(), [](const json& leaf) { return !leaf.is_null(); });
    };
    Scene scene;
    CHECK_FALSE(has_a_value(json::parse(write_json(scene))));  // defaults are not written
    scene.boundaries.resize(1);
    scene.surface.zones.resize(1);
    scene.ground.kind = GroundKind::section;
    scene.ground.section.layers.resize(1);
    CHECK_FALSE(has_a_value(json::parse(write_json(scene))));

    const Soil soil = one_soil("{}").soils[0];
    CHECK(std::isnan(soil.porosity));
    CHECK(soil.hydraulics.retention.alpha == 0);
    CHECK(soil.hydraulics.retention.maximum_saturation == 1);
    CHECK(soil.solid.model == Solid().model);
    CHECK(soil.solid.strength.model == Strength().model);
    CHECK(soil.solid.tensile_strength == infinite);
    CHECK(std::isnan(soil.solid.strength.cohesion));  // 0 is a value of its own
    CHECK(std::isnan(soil.solid.poisson_ratio));
}

TEST_CASE("every choice has its name") {
    CHECK(retention("vanGenuchten").model == RetentionModel::van_genuchten);
    CHECK(retention("gardner").model == RetentionModel::gardner);
    CHECK(retention("brooksCorey").model == RetentionModel::brooks_corey);
    CHECK(retention("tabulated").model == RetentionModel::tabulated);

    CHECK(permeability("mualem").model == PermeabilityModel::mualem);
    CHECK(permeability("constant").model == PermeabilityModel::constant);
    CHECK(permeability("gardner").model == PermeabilityModel::gardner);
    CHECK(permeability("power").model == PermeabilityModel::power);
    CHECK(permeability("brooksCorey").model == PermeabilityModel::brooks_corey);
    CHECK(permeability("tabulated").model == PermeabilityModel::tabulated);

    const auto porosity_dependence = [](const std::string& name) {
        const std::string text = R"({"hydraulics": {"conductivity": {"porosityDependence": ")" + name + R"("}}})";
        return one_soil(text).soils[0].hydraulics.conductivity.porosity_dependence;
    };
    CHECK(porosity_dependence("none") == PorosityDependence::none);
    CHECK(porosity_dependence("kozenyCarman") == PorosityDependence::kozeny_carman);

    const auto solid = [](const std::string& name) {
        return one_soil(R"({"solid": {"model": ")" + name + R"("}})").soils[0].solid.model;
    };
    CHECK(solid("elastic") == SolidModel::elastic);
    CHECK(solid("mohrCoulomb") == SolidModel::mohr_coulomb);

    const auto strength = [](const std::string& name) {
        return one_soil(R"({"solid": {"strength": {"model": ")" + name + R"("}}})").soils[0].solid.strength.model;
    };
    CHECK(strength("constant") == StrengthModel::constant);
    CHECK(strength("fredlund") == StrengthModel::fredlund);
    CHECK(strength("vanapalli") == StrengthModel::vanapalli);
    CHECK(strength("exponential") == StrengthModel::exponential);

    CHECK(boundary(R"("flow": "impermeable")").flow == FlowCondition::impermeable);
    CHECK(boundary(R"("flow": "pressure")").flow == FlowCondition::pressure);
    CHECK(boundary(R"("flow": "hydrostatic")").flow == FlowCondition::hydrostatic);
    CHECK(boundary(R"("flow": "flux")").flow == FlowCondition::flux);
    CHECK(boundary(R"("flow": "surface")").flow == FlowCondition::surface);
    CHECK_FALSE(boundary(R"("flow": "unspecified")").has_flow);
    CHECK(boundary(R"("motion": "free")").motion == MotionCondition::free);
    CHECK(boundary(R"("motion": "roller")").motion == MotionCondition::roller);
    CHECK(boundary(R"("motion": "fixed")").motion == MotionCondition::fixed);
    CHECK(boundary(R"("motion": "displacement")").motion == MotionCondition::displacement);
    CHECK(boundary(R"("motion": "traction")").motion == MotionCondition::traction);
    CHECK(boundary(R"("motion": "friction")").motion == MotionCondition::friction);
    CHECK(read_json(R"({"physics": {"regime": "quasiStatic"}})").physics.regime == MotionRegime::quasi_static);
    CHECK(read_json(R"({"physics": {"regime": "dynamic"}})").physics.regime == MotionRegime::dynamic);
    CHECK(read_json(R"({"initial": {"stress": "elastic"}})").initial.stress == InitialStress::elastic);
    CHECK_FALSE(boundary(R"("motion": "unspecified")").has_motion);

    const auto initial = [](const std::string& field, const std::string& name) {
        return read_json(R"({"initial": {")" + field + R"(": ")" + name + R"("}})").initial;
    };
    CHECK(initial("flow", "suction").flow == InitialFlow::suction);
    CHECK(initial("flow", "saturation").flow == InitialFlow::saturation);
    CHECK(initial("flow", "hydrostatic").flow == InitialFlow::hydrostatic);
    CHECK(initial("flow", "steady").flow == InitialFlow::steady);
    CHECK(initial("stress", "gravity").stress == InitialStress::gravity);
    CHECK(initial("stress", "k0").stress == InitialStress::k0);
    CHECK(initial("stress", "zero").stress == InitialStress::zero);
    CHECK(read_json(R"({"physics": {"stress": "net"}})").physics.stress == StressMeasure::net);
    CHECK(read_json(R"({"physics": {"stress": "bishop"}})").physics.stress == StressMeasure::bishop);
}

TEST_CASE("texts are UTF-8 with JSON's escapes") {
    CHECK(read_json("{\"title\": \"H\u00fcgel \u26f0\"}").title == "H\u00fcgel \u26f0");
    CHECK(read_json(R"({"title": "a\"b\\c\/d\n\t"})").title == "a\"b\\c/d\n\t");
    CHECK(read_json(R"({"title": "H\u00fcgel \u26F0 \ud83c\udfde \u0022\u005c\\u0041"})").title ==
          "H\u00fcgel \u26f0 \U0001f3de \"\\\\u0041");
    const Scene scene = read_json(R"({"title": "a\"b\\c\n"})");
    CHECK(read_json(write_json(scene)).title == scene.title);
}

TEST_CASE("all misfits of the JSON are said at once") {
    const std::string text =
        R"({"nam": "x", "gravity": "9.81", "soils": [{"porosity": 0.4, "porosity": 0.4}, 3], "physics": {"stress": "nett"}})";
    std::string said;
    try {
        (void)read_json(text);
    } catch (const Error& error) {
        said = error.what();
    }
    CHECK(said ==
          "nam: is unknown; did you mean name?\n"
          "gravity: is the text \"9.81\"; must be a number\n"
          "soils[0].porosity: is given twice\n"
          "soils[1]: is the number 3; must be an object {...}\n"
          "physics.stress: is the text \"nett\"; must be one of net, bishop (did you mean net?)");
}

/// Sets a locale with decimal commas, in glibc's binary form: LC_NUMERIC with decimal_point ",", thousands_sep ".", grouping
/// 3;3. Systems need not have any such locale installed.
bool set_decimal_commas() {
    constexpr unsigned char numeric[] = {0x14, 0x11, 0x03, 0x20, 6,   0, 0,    0,   0x20, 0,   0,    0, 0x22, 0,
                                         0,    0,    0x24, 0,    0,   0, 0x28, 0,   0,    0,   0x2c, 0, 0,    0,
                                         0x30, 0,    0,    0,    ',', 0, '.',  0,   3,    3,   0,    0, ',',  0,
                                         0,    0,    '.',  0,    0,   0, 'U',  'T', 'F',  '-', '8',  0};
    const auto folder = std::filesystem::temp_directory_path() / ("talus_locale_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder / "xx_XX.UTF-8");
    std::ofstream(folder / "xx_XX.UTF-8" / "LC_NUMERIC", std::ios::binary)
        .write(reinterpret_cast<const char*>(numeric), sizeof numeric);
    setenv("LOCPATH", folder.c_str(), 1);
    const bool set = std::setlocale(LC_NUMERIC, "xx_XX.UTF-8") != nullptr;
    unsetenv("LOCPATH");
    std::filesystem::remove_all(folder);
    return set;
}

TEST_CASE("a locale with decimal commas changes nothing") {
    const std::string before = write_json(read_json(sample_text("slope")));
    REQUIRE(set_decimal_commas());
    REQUIRE(std::string(std::localeconv()->decimal_point) == ",");
    const Scene scene = read_json(sample_text("slope"));
    const std::string after = write_json(scene);
    std::string said;
    try {
        (void)read_json(R"({"gravity": 9,81})");
    } catch (const Error& error) {
        said = error.what();
    }
    std::setlocale(LC_NUMERIC, "C");
    CHECK(scene.soils[0].hydraulics.retention.n == 1.2);
    CHECK(scene.surface.zones[0].rate[0] == 3.3333333333333333e-06);
    CHECK(after == before);
    CHECK(said.starts_with("JSON text: line 1, column 15"));
}

}  // namespace

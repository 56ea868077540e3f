// talus: runs and checks scenes. A host on the C API alone.
#include "runner/host.hpp"
#include "runner/run.hpp"
#include "runner/table.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>

namespace {

constexpr int failed = 1;
constexpr int wrong_use = 2;

/// A scene that cannot be run: 2, as a wrong command line. Everything else that fails: 1.
int exit_status(const runner::Failure& failure) {
    return failure.status == TALUS_INVALID_SCENE || failure.status == TALUS_INPUT_OUTPUT ? wrong_use : failed;
}

int check_scene(const std::string& path) {
    const runner::Scene scene = runner::load_scene(path);
    const talus_options options = TALUS_OPTIONS_INIT;
    runner::print_description(runner::describe(runner::create_engine(scene, options)));
    return 0;
}

int dispatch(int argc, char** argv) {
    CLI::App app(
        "Talus: rainfall-induced landslides. Exit status: 0 done, 1 the run failed, 2 wrong use or wrong scene, "
        "130 cancelled.");
    app.require_subcommand(1);
    app.set_version_flag("--version", std::string("talus ") + talus_version());

    runner::RunSettings settings;
    CLI::App* run = app.add_subcommand("run", "Follow a scene's schedule; write report.json, probes.csv, *.pvd");
    run->add_option("SCENE", settings.scene, "scene file, JSON or Cap'n Proto")->required();
    run->add_option("--out", settings.out, "folder of the results, made when it is not there")->required();
    run->add_option("--tolerance", settings.tolerance, "error allowed in time, instead of the scene's");
    run->add_option("--step", settings.step, "step in s, instead of the scene's")->check(CLI::PositiveNumber);

    run->add_option("--threads", settings.threads, "threads of a dynamic ground, 1 when left out")
        ->check(CLI::PositiveNumber);

    std::string scene;
    CLI::App* check = app.add_subcommand("check", "Check a scene and say what it is");
    check->add_option("SCENE", scene, "scene file, JSON or Cap'n Proto")->required();

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : wrong_use;
    }
    return run->parsed() ? runner::run(settings) : check_scene(scene);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return dispatch(argc, argv);
    } catch (const runner::Failure& failure) {
        std::fprintf(stderr, "talus: %s\n", failure.what());
        return exit_status(failure);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "talus: %s\n", error.what());
        return failed;
    }
}

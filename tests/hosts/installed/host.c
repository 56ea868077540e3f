/* A host that has nothing but an installed Talus: an hour of rain on a column of soil, every drop accounted for. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <talus/talus.h>

static const char scene_text[] =
    "{\"name\": \"column\", \"physics\": {\"deforming\": false},"
    " \"soils\": [{\"name\": \"soil\", \"porosity\": 0.4, \"hydraulics\": {"
    "   \"retention\": {\"model\": \"vanGenuchten\", \"alpha\": 4e-05, \"n\": 1.2},"
    "   \"relativePermeability\": {\"model\": \"mualem\"}, \"conductivity\": {\"along\": 1e-4}}}],"
    " \"ground\": {\"column\": {\"height\": 1.0, \"cells\": 20, \"layers\": [{\"soil\": \"soil\"}]}},"
    " \"surface\": {\"zones\": [{\"name\": \"rain\"}]},"
    " \"initial\": {\"flow\": \"saturation\", \"saturation\": 0.85}}";

int main(void) {
    const double rate = 1e-6;
    talus_scene* scene = 0;
    talus_engine* engine = 0;
    talus_step_report report = TALUS_STEP_REPORT_INIT;
    talus_field pressure = TALUS_FIELD_INIT;

    if (strcmp(talus_version(), TALUS_EXPECTED_VERSION) != 0) return 1;
    if (talus_scene_from_json(scene_text, -1, &scene) < 0 || talus_engine_create(scene, 0, &engine) < 0) {
        puts(talus_last_error());
        return 1;
    }
    talus_scene_release(scene);
    talus_engine_set_rain(engine, 0, rate);
    while (talus_engine_time(engine) < 3600) {
        if (talus_engine_step(engine, 600, &report) < 0) {
            puts(talus_engine_error(engine));
            return 1;
        }
    }
    if (talus_engine_view(engine, "pressure", &pressure) < 0) {
        puts(talus_engine_error(engine));
        return 1;
    }
    printf("Talus %s: %g m of rain, %g m taken, %d pressures\n", talus_version(), report.water_rain,
           report.water_infiltrated, (int)pressure.shape[0]);
    talus_engine_destroy(engine);
    return fabs(report.water_rain - 3600 * rate) < 1e-12 && pressure.shape[0] > 0 ? 0 : 1;
}

/* Rain alarm: a host of Talus in C99.

   Rain gauges report; a slope is watched. This program reads a rain gauge's file line by line, as an early-warning system
   would get it from its gauges, gives each line to the engine, lets the engine catch up, and prints an alarm when

     - the pore pressure at a probe rises above PRESSURE_ALARM,
     - the least local factor of safety falls below FACTOR_ALARM,
     - something happens that the engine calls an event: water runs off, seeps out, the slope fails.

   Sample run, in the folder samples/hosts:

     ../../build/release/bin/rain_alarm ../scenes/slope.json storm.csv A B C

   The steps are numbered as in docs/api.md: 1 load the scene, 2 create the engine, 3 push rain, 4 step, 5 look, 6 clean up. */

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <talus/talus.h>

#define MAX_PROBES 16
#define PRESSURE_ALARM (-15e3) /* Pa: the wet front has arrived */
#define FACTOR_ALARM 1.05
#define MILLIMETRES_PER_HOUR (1e-3 / 3600) /* m/s: Talus takes SI units and nothing else */
#define HOUR 3600.0

typedef struct {
    const char* name;
    int32_t number;
    int raised;
} probe;

typedef struct {
    talus_engine* engine;
    probe probes[MAX_PROBES];
    int probe_count;
    int64_t events_seen;
    int factor_raised;
} watch;

/* Every call returns a status; below 0 nothing was done, and the text says what, where and when. A host that runs for months
   would log it and go on: a failed call leaves the engine as it was. This one stops. */
static talus_status must(talus_status status) {
    if (status < 0) {
        fprintf(stderr, "rain_alarm: %s: %s\n", talus_status_name(status), talus_last_error());
        exit(1);
    }
    return status;
}

/* The engine's own remarks: Talus never prints, it tells its host. */
static void log_line(void* user, int32_t level, const char* text) {
    (void)user;
    fprintf(stderr, "%s%s\n", level >= TALUS_LOG_WARNING ? "warning: " : "", text);
}

static void alarm_text(double time, const char* text) { printf("%7.2f h  ALARM  %s\n", time / HOUR, text); }

/* Step 5, look. A history's pointers are the engine's own memory: good until the next step, so they are used at once. */
static void check_probe(watch* w, probe* p) {
    char text[160];
    talus_history history = TALUS_HISTORY_INIT;
    double pressure;
    must(talus_engine_probe_history(w->engine, p->number, "pressure", &history));
    pressure = history.value[history.count - 1];
    if (pressure > PRESSURE_ALARM && !p->raised) {
        snprintf(text, sizeof text, "probe %s: pore pressure is %.2f kPa", p->name, pressure / 1e3);
        alarm_text(talus_engine_time(w->engine), text);
    }
    p->raised = pressure > PRESSURE_ALARM;
}

static void check_factor(watch* w, const talus_step_report* report) {
    char text[160];
    const double factor = report->least_factor_of_safety; /* 0 where none is known: a rigid ground does not fail */
    const int low = factor > 0 && factor < FACTOR_ALARM;
    if (low && !w->factor_raised) {
        snprintf(text, sizeof text, "least local factor of safety is %.3f", factor);
        alarm_text(report->time, text);
    }
    w->factor_raised = low;
}

static void check_events(watch* w) {
    int64_t count = 0;
    must(talus_engine_event_count(w->engine, &count));
    for (; w->events_seen < count; ++w->events_seen) {
        talus_event event = TALUS_EVENT_INIT;
        must(talus_engine_event(w->engine, w->events_seen, &event));
        alarm_text(event.time, event.message);
    }
}

/* Step 4, step: to the end of this line's interval. The engine chooses its own time steps within. Past the end of the pushed
   rain the last rate holds, so a line is pushed before its interval is stepped over. */
static void catch_up(watch* w, double time) {
    talus_step_report report = TALUS_STEP_REPORT_INIT;
    int i;
    must(talus_engine_advance_to(w->engine, time, &report));
    for (i = 0; i < w->probe_count; ++i) check_probe(w, &w->probes[i]);
    check_factor(w, &report);
    check_events(w);
}

static void summary(watch* w) {
    talus_step_report report = TALUS_STEP_REPORT_INIT;
    int64_t hash = 0;
    must(talus_engine_report(w->engine, &report));
    must(talus_engine_hash(w->engine, &hash));
    printf("%7.2f h  rain %.3f, infiltrated %.3f, run-off %.3f m3/m; largest displacement %.1f mm\n",
           report.time / HOUR, report.water_rain, report.water_infiltrated, report.water_run_off,
           1e3 * report.largest_displacement);
    printf("%d bad gauge values were replaced; state %016llx\n", (int)report.rain_substitutions,
           (unsigned long long)hash);
}

/* Reads "hours,millimetres per hour": from that time on it rains so much; the last line ends the rain. Lines that begin with
   # are remarks. 1 when a line was read, 0 at the end. */
static int read_line(FILE* file, double* time, double* rate) {
    char line[256];
    while (fgets(line, sizeof line, file)) {
        char* comma = strchr(line, ',');
        if (line[0] == '#' || !comma) continue;
        *time = strtod(line, NULL) * HOUR;
        *rate = strtod(comma + 1, NULL) * MILLIMETRES_PER_HOUR; /* "nan" where the gauge was out of order */
        return 1;
    }
    return 0;
}

static void stream(watch* w, FILE* file) {
    double time, rate;
    while (read_line(file, &time, &rate)) {
        /* The rain until now is known: let the engine catch up ... */
        if (time > talus_engine_time(w->engine)) catch_up(w, time);
        /* ... step 3, push: and this is the rate from now on, on the scene's first rain zone. */
        must(talus_engine_push_rain(w->engine, 0, 1, &time, &rate));
    }
}

int main(int argc, char** argv) {
    watch w = {0};
    talus_scene* scene = NULL;
    talus_options options = TALUS_OPTIONS_INIT;
    FILE* file;
    int i;
    if (argc < 3 || argc > 3 + MAX_PROBES) {
        fprintf(stderr, "usage: rain_alarm SCENE RAIN.csv [PROBE ...]\n");
        return 2;
    }
    file = fopen(argv[2], "r");
    if (!file) {
        fprintf(stderr, "rain_alarm: cannot open %s\n", argv[2]);
        return 2;
    }

    /* 1. The scene: what is simulated. A wrong one is refused with all that is wrong with it. */
    must(talus_scene_from_file(argv[1], &scene));

    /* 2. The engine: one run in time, at time 0. It keeps the scene alive, so ours may go. A gauge that fails must not make
       the slope look safer: its last good value is held, and counted. */
    options.rain_policy = TALUS_RAIN_HOLD;
    options.log = log_line;
    must(talus_engine_create(scene, &options, &w.engine));
    must(talus_scene_release(scene));

    /* Names become numbers once, outside the loop. */
    for (i = 3; i < argc; ++i) {
        probe* p = &w.probes[w.probe_count++];
        p->name = argv[i];
        must(talus_engine_probe(w.engine, p->name, &p->number));
    }

    stream(&w, file);
    summary(&w);

    /* 6. What was created is destroyed. */
    talus_engine_destroy(w.engine);
    fclose(file);
    return 0;
}

/* Talus: an embeddable simulation engine for rainfall-induced landslides.

   Two nouns: a scene (terrain, soils, physics: immutable, shareable) and an engine (one run in time).
   Five verbs: push rain, step, view, read, sample.

       talus_scene *scene;
       talus_engine *engine;
       talus_step_report report = TALUS_STEP_REPORT_INIT;
       if (talus_scene_from_file("slope.json", &scene) < 0) puts(talus_last_error());
       if (talus_engine_create(scene, 0, &engine) < 0) puts(talus_last_error());
       talus_scene_release(scene);
       talus_engine_set_rain(engine, 0, 0.012 / 3600);
       while (talus_engine_time(engine) < 36 * 3600.0) talus_engine_step(engine, 3600, &report);
       talus_engine_destroy(engine);

   Units     SI: m, s, Pa, kg/m3. Rain is m3 per horizontal m2 and second, m/s (1 mm/h = 1 / 3.6e6 m/s). y is up.
             Stress is tension-positive, pore pressure compression-positive, gauge.
   Arrays    are C-ordered: the components of a row stay together. A tensor's are xx, yy, zz, xy.
   Status    0 done; > 0 done or undone, look; < 0 error, nothing changed. A failed or cancelled step leaves the engine
             as it was before it, bit for bit.
   Message   talus_engine_error is the text of the last call on that engine that failed; talus_last_error that of the last
             call of any kind in this thread that failed. It says what, where and when.
   Lifetime  a pointer that an engine gives is valid until talus_engine_epoch changes, which only a step that changes the
             state does, and until talus_engine_destroy.
   Threads   different engines from different threads at once; one engine from one thread at a time; talus_engine_cancel
             and talus_engine_time from any. Results do not depend on threads.
   Host      Talus never exits, aborts, throws, prints, changes the locale, the environment, the folder or signal handlers,
             and gives the floating-point environment back as it found it.

   Structs begin with struct_size; begin each with its TALUS_..._INIT. Zero means default. Text is UTF-8. */

#ifndef TALUS_TALUS_H
#define TALUS_TALUS_H

#include <stdint.h>

#if defined(_WIN32)
#define TALUS_API __declspec(dllimport)
#elif defined(__GNUC__)
#define TALUS_API __attribute__((visibility("default")))
#else
#define TALUS_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* The version of this header. The ABI number is the one in the library's name. */
#define TALUS_VERSION_MAJOR 0
#define TALUS_VERSION_MINOR 1
#define TALUS_VERSION_PATCH 0
#define TALUS_ABI 0

typedef struct talus_scene talus_scene;
typedef struct talus_engine talus_engine;

/* --- status: values are frozen ------------------------------------------------------------------------------------ */

typedef int32_t talus_status;

#define TALUS_OK 0
#define TALUS_CANCELLED 1         /* the host asked to stop; the step was undone */
#define TALUS_OUT_OF_RAIN 2       /* the step was done, and went past the end of a rain series: the last rate was held */
#define TALUS_OUTSIDE 3           /* some places lie outside the ground; their values are NaN */
#define TALUS_ENDED_EARLY 4       /* the step was done up to the report's time, see talus_options.stop_at_motion */
#define TALUS_INVALID_HANDLE -1   /* NULL, destroyed or foreign */
#define TALUS_INVALID_ARGUMENT -2
#define TALUS_INVALID_SCENE -3    /* the message lists every problem of the scene, a line each */
#define TALUS_UNKNOWN_NAME -4     /* no such field, zone, boundary, probe or quantity */
#define TALUS_NOT_CONVERGED -5    /* the solver stopped; this says nothing about the slope */
#define TALUS_OUT_OF_MEMORY -6
#define TALUS_INPUT_OUTPUT -7     /* a file could not be read */
#define TALUS_INTERNAL -8         /* a defect of Talus, or an exception from a callback */
#define TALUS_BUSY -9             /* another call on this engine is running: in another thread, or around this callback */

/* --- values of the int32_t members -------------------------------------------------------------------------------- */

#define TALUS_FLOAT64 0           /* type of a field or an array */
#define TALUS_INT32 1

#define TALUS_NODE 0              /* location of a field: a row for each node, */
#define TALUS_POINT 1             /* material point, */
#define TALUS_CELL 2              /* cell, */
#define TALUS_MESH 3              /* or rows of their own: how cells join nodes */

#define TALUS_QUASI_STATIC 0      /* regime: the ground is in equilibrium; */
#define TALUS_EQUILIBRIUM_LOST 1  /* failure was found: the skeleton stands as it was, the flow goes on; */
#define TALUS_DYNAMIC 2           /* or the ground moves by its momentum, as the scene's physics.regime says */
#define TALUS_AT_REST 3           /* it failed, moved and rests: no water moves until it settles (TALUS_SETTLED) */

#define TALUS_SATURATED 1         /* kind of an event: the last pore of the ground filled */
#define TALUS_PONDING_STARTED 2   /* water stands on the surface, or runs off */
#define TALUS_PONDING_ENDED 3
#define TALUS_SEEPAGE_STARTED 4   /* water comes out of the surface */
#define TALUS_LOSS_OF_EQUILIBRIUM 5 /* no equilibrium exists: failure */
#define TALUS_RAIN_ENDED 6        /* the step went past the end of the rain series */
#define TALUS_MOTION_STARTED 7    /* the ground that failed moves by its momentum */
#define TALUS_CAME_TO_REST 8      /* the ground that moved rests */
#define TALUS_SETTLED 9           /* it lies on a mesh again; value 1: in equilibrium, 0: none found, its skeleton stands */
#define TALUS_LEFT_BACKGROUND 10  /* moving ground came to an end of its background; value: what was taken out, m3 per metre */

#define TALUS_RAIN_REJECT 0       /* what to do with a NaN or negative rate: an error, */
#define TALUS_RAIN_HOLD 1         /* the last good rate before it, counted in the step report, */
#define TALUS_RAIN_ZERO 2         /* or no rain, counted in the step report */

#define TALUS_LOG_INFORMATION 1   /* level of a log line */
#define TALUS_LOG_WARNING 2

/* --- structs ------------------------------------------------------------------------------------------------------ */

/* Called in the thread of the call that caused it, holding no lock. From within, only talus_engine_cancel, _time and
   _epoch may be called on the same engine. */
typedef void (*talus_log_callback)(void *user, int32_t level, const char *text);
/* Called within a step with the fraction of it that is done, 0 to 1. Non-zero cancels the step. */
typedef int32_t (*talus_progress_callback)(void *user, double fraction);

typedef struct talus_options {
    int32_t struct_size;
    int32_t rain_policy;               /* TALUS_RAIN_... */
    double tolerance;                  /* error allowed in time and in the sub-stepping; 0: the scene's */
    talus_log_callback log;            /* 0: none */
    void *log_user;
    talus_progress_callback progress;  /* 0: none */
    void *progress_user;
    int32_t threads;                   /* of a dynamic ground; 0: one. Results do not depend on it */
    int32_t stop_at_motion;            /* not 0: a step ends where ground of the regime auto starts to move or comes to rest */
} talus_options;
#define TALUS_OPTIONS_INIT { sizeof(talus_options), 0, 0.0, 0, 0, 0, 0, 0, 0 }

/* An array of the host's that stands for an entry of a scene's JSON text, see talus_scene_from_json_with_arrays. */
typedef struct talus_array {
    int32_t struct_size;
    int32_t type;                      /* TALUS_FLOAT64 or TALUS_INT32 */
    const char *entry;                 /* "ground.mesh.position" */
    const void *data;                  /* count values, consecutive */
    int64_t count;
} talus_array;
#define TALUS_ARRAY_INIT { sizeof(talus_array), 0, 0, 0, 0 }

/* A field in the engine's memory. */
typedef struct talus_field {
    int32_t struct_size;
    int32_t type;                      /* TALUS_FLOAT64 or TALUS_INT32 */
    int32_t location;                  /* TALUS_NODE ... */
    int32_t rank;                      /* 1: scalars; 2: rows of components */
    int64_t shape[4];                  /* rows, components */
    int64_t strides[4];                /* bytes from one index to the next */
    const void *data;
    const char *name;
    const char *units;                 /* UDUNITS text, "1" where there is none */
    const char *standard_name;         /* CSDMS standard name, "" where there is none */
    int64_t epoch;                     /* the memory is as described while talus_engine_epoch is this */
} talus_field;
#define TALUS_FIELD_INIT { sizeof(talus_field), 0, 0, 0, { 0, 0, 0, 0 }, { 0, 0, 0, 0 }, 0, 0, 0, 0, 0 }

/* Water is in m3 per metre of thickness (plane strain) or per m2 (column), since the start of the run:
   rain = infiltrated + run_off;  stored - initial = infiltrated + inflow - seepage - drained + residual. */
typedef struct talus_step_report {
    int32_t struct_size;
    int32_t regime;                    /* TALUS_QUASI_STATIC ... */
    double time;                       /* s, after the step */
    int64_t flow_substeps;             /* of this step */
    int64_t flow_failures;             /* substeps that were tried again, smaller */
    int64_t flow_iterations;           /* Newton iterations of the flow */
    int64_t coupling_steps;            /* exchanges between flow and motion */
    int64_t coupling_iterations;
    int64_t motion_iterations;         /* Newton iterations of the equilibrium */
    int64_t rain_substitutions;        /* rates that rain_policy replaced, since the start */
    double water_rain;                 /* fallen on the ground surface */
    double water_infiltrated;          /* taken by the ground surface, what ponds on it included */
    double water_run_off;              /* rain that the ground surface did not take */
    double water_seepage;              /* come out of the ground surface, as vapour too */
    double water_inflow;               /* come in through the other boundaries */
    double water_drained;              /* gone out through the other boundaries */
    double water_stored;               /* in the pores and ponded, now */
    double water_initial;              /* in the pores and ponded, at the start */
    double water_residual;             /* what the balance misses */
    double largest_displacement;       /* m, since the start */
    double largest_velocity;           /* m/s, mean over the step; of a dynamic ground: of a point, at the step's end */
    double least_factor_of_safety;     /* least local one; 0 where none is known */
    double seconds_flow;               /* wall seconds of this step */
    double seconds_motion;
    double seconds_total;
    int64_t motion_substeps;           /* this and what follows: of ground in motion, at the step's end or where it came to
                                          rest within it; else 0; per metre of thickness */
    double kinetic_energy;             /* J, of the points' velocity */
    double elastic_energy;             /* J, of their stress */
    double potential_energy;           /* J, of their weight above y = 0 */
    double dissipated_energy;          /* J: what the sum of the three has lost since the start, or since the motion began */
    double peak_velocity;              /* m/s, largest of a point in the step, looked at every few substeps */
    double sliding_volume;             /* m3, of the points displaced by more than a cell's size since the start */
    double front_x;                    /* m, of the foremost of these, in the direction that they go on the whole */
    double run_out;                    /* m: so far in front of where the foremost of these lay at the start it lies */
} talus_step_report;
#define TALUS_STEP_REPORT_INIT { sizeof(talus_step_report), 0, 0.0, 0, 0, 0, 0, 0, 0, 0, \
    0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, \
    0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0 }

typedef struct talus_event {
    int32_t struct_size;
    int32_t kind;                      /* TALUS_SATURATED ... */
    double time;                       /* s */
    double x;                          /* m */
    double y;
    double value;                      /* what the kind says */
    const char *message;
} talus_event;
#define TALUS_EVENT_INIT { sizeof(talus_event), 0, 0.0, 0.0, 0.0, 0.0, 0 }

/* The history of a probe: a row for the start and one for each step. */
typedef struct talus_history {
    int32_t struct_size;
    int32_t reserved;
    int64_t count;
    const double *time;                /* s */
    const double *value;               /* NaN before the probe was added */
    int64_t epoch;                     /* as in talus_field */
} talus_history;
#define TALUS_HISTORY_INIT { sizeof(talus_history), 0, 0, 0, 0, 0 }

/* A raster in the plane of the section: value [row][column] is at (x + column dx, y + row dy). A negative dy gives rows
   from the top down, as images and GeoTIFF have them. */
typedef struct talus_raster {
    int32_t struct_size;
    int32_t columns;
    int32_t rows;
    int32_t reserved;
    double x;                          /* m, centre of the first value's pixel */
    double y;
    double dx;                         /* m, not 0 */
    double dy;
} talus_raster;
#define TALUS_RASTER_INIT { sizeof(talus_raster), 0, 0, 0, 0.0, 0.0, 0.0, 0.0 }

/* --- library ------------------------------------------------------------------------------------------------------ */

TALUS_API const char *talus_version(void);     /* "0.1.0" */
TALUS_API int32_t talus_abi(void);             /* TALUS_ABI of the library */
TALUS_API const char *talus_build_info(void);  /* JSON: version, ABI, compiler, build type, libraries */
TALUS_API const char *talus_status_name(talus_status status);  /* "not_converged"; "unknown" for other values */
/* Text of this thread's last call that failed; valid until its next call of Talus; never NULL. */
TALUS_API const char *talus_last_error(void);

/* --- scene: may be used from several threads at once -------------------------------------------------------------- */

/* Reads and checks a scene, docs/scenes.md. A scene that cannot be run is TALUS_INVALID_SCENE with a line for each problem:
   the entry's path, the value, what is allowed. *out has one reference. length < 0: the text ends with a zero byte. */
TALUS_API talus_status talus_scene_from_json(const char *text, int64_t length, talus_scene **out);
TALUS_API talus_status talus_scene_from_bytes(const void *bytes, int64_t length, talus_scene **out);  /* Cap'n Proto */
TALUS_API talus_status talus_scene_from_file(const char *path, talus_scene **out);  /* either; told by its content */
/* As talus_scene_from_json, with entries of the text given as arrays of the host's, which are copied: mesh, terrain, rain,
   tables, places of probes. The entries are listed in docs/api.md. An entry that the text also gives is an error. */
TALUS_API talus_status talus_scene_from_json_with_arrays(const char *text, int64_t length, int32_t array_count,
                                                         const talus_array *arrays, talus_scene **out);
TALUS_API talus_status talus_scene_retain(talus_scene *scene);   /* one reference more */
TALUS_API talus_status talus_scene_release(talus_scene *scene);  /* one less; engines have references of their own */

/* --- engine: one run in time -------------------------------------------------------------------------------------- */

/* Sets up the run at time 0: initial pore pressure, stress in equilibrium. options may be NULL. */
TALUS_API talus_status talus_engine_create(talus_scene *scene, const talus_options *options, talus_engine **out);
TALUS_API void talus_engine_destroy(talus_engine *engine);  /* NULL is allowed; waits for nobody */
/* Text of the last call on this engine that failed; valid until the next call on it; never NULL. Not for another thread. */
TALUS_API const char *talus_engine_error(talus_engine *engine);
/* JSON: the physics composed and what was left out, sizes, schedule, zones, boundaries, probes, fields; docs/api.md. */
TALUS_API talus_status talus_engine_describe(talus_engine *engine, const char **json);

/* Push. A series pushed from time[0] on replaces what was known of that time and later: a forecast may be revised.
   time is increasing, in s, and not before the engine's; count >= 1.
   rate[k] m/s holds over [time[k], time[k+1]); the last rate holds until changed. */
TALUS_API talus_status talus_engine_zone(talus_engine *engine, const char *name, int32_t *zone);
TALUS_API talus_status talus_engine_push_rain(talus_engine *engine, int32_t zone, int64_t count, const double *time,
                                              const double *rate);
TALUS_API talus_status talus_engine_set_rain(talus_engine *engine, int32_t zone, double rate);  /* from now on */
/* The value of a boundary: linear between times, constant after the last. Flow: Pa, m of water table, or m/s, as the scene
   has it there. Motion: m or Pa; component 0 is x, 1 is y. */
TALUS_API talus_status talus_engine_boundary(talus_engine *engine, const char *name, int32_t *boundary);
TALUS_API talus_status talus_engine_push_flow_value(talus_engine *engine, int32_t boundary, int64_t count,
                                                    const double *time, const double *value);
TALUS_API talus_status talus_engine_push_motion_value(talus_engine *engine, int32_t boundary, int32_t component,
                                                      int64_t count, const double *time, const double *value);

/* Step. dt s of physical time, or to exactly that time; the engine sub-steps within. report may be NULL.
   TALUS_ENDED_EARLY: done, but not as far, where the options ask for it.
   TALUS_CANCELLED and errors: nothing changed, the next step works. */
TALUS_API talus_status talus_engine_step(talus_engine *engine, double dt, talus_step_report *report);
TALUS_API talus_status talus_engine_advance_to(talus_engine *engine, double time, talus_step_report *report);
TALUS_API void talus_engine_cancel(talus_engine *engine);     /* any thread: ends the step that runs, or else the next */
TALUS_API double talus_engine_time(talus_engine *engine);     /* any thread: s; NaN for an invalid handle */
TALUS_API int64_t talus_engine_epoch(talus_engine *engine);   /* -1 for an invalid handle */
TALUS_API talus_status talus_engine_report(talus_engine *engine, talus_step_report *report);  /* the last step's */

/* Query. Fields are listed by index and in describe. */
TALUS_API talus_status talus_engine_field_count(talus_engine *engine, int32_t *count);
TALUS_API talus_status talus_engine_field_name(talus_engine *engine, int32_t index, const char **name);
TALUS_API talus_status talus_engine_view(talus_engine *engine, const char *field, talus_field *out);  /* no copy */
/* Copies a field of count values (rows times components); integers become double exactly. */
TALUS_API talus_status talus_engine_read(talus_engine *engine, const char *field, int64_t count, double *values);
/* Values of a field at count places (count x dimension: x, y; in a column y alone): count x components. */
TALUS_API talus_status talus_engine_sample(talus_engine *engine, const char *field, int64_t count, const double *places,
                                           double *values);
/* The same on a raster: count = rows x columns x components. Plane scenes only. */
TALUS_API talus_status talus_engine_sample_raster(talus_engine *engine, const char *field, const talus_raster *raster,
                                                  int64_t count, double *values);

/* Probes: those of the scene, in its order, and those added. A quantity is a scalar field, or field.component: "pressure",
   "displacement.x", "net_stress.xy". */
TALUS_API talus_status talus_engine_probe(talus_engine *engine, const char *name, int32_t *probe);
TALUS_API talus_status talus_engine_add_probe(talus_engine *engine, const char *name, double x, double y, int32_t *probe);
TALUS_API talus_status talus_engine_probe_history(talus_engine *engine, int32_t probe, const char *quantity,
                                                  talus_history *out);

TALUS_API talus_status talus_engine_event_count(talus_engine *engine, int64_t *count);
TALUS_API talus_status talus_engine_event(talus_engine *engine, int64_t index, talus_event *out);
TALUS_API talus_status talus_engine_hash(talus_engine *engine, int64_t *hash);  /* of the state, bit for bit */

#ifdef __cplusplus
}
#endif

#endif

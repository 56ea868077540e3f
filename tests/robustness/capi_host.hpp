// A host of the C API for tests: small scenes, handles that release themselves.
#pragma once

#include <doctest/doctest.h>
#include <talus/talus.h>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>

namespace host {

struct Release {
    void operator()(talus_scene* scene) const { talus_scene_release(scene); }
    void operator()(talus_engine* engine) const { talus_engine_destroy(engine); }
};
using Scene = std::unique_ptr<talus_scene, Release>;
using Engine = std::unique_ptr<talus_engine, Release>;

/// A rigid column that fills with rain in 600 s.
inline const char* const column_text = R"({
    "name": "column",
    "physics": {"deforming": false},
    "soils": [{"name": "soil", "porosity": 0.4,
               "hydraulics": {"retention": {"model": "vanGenuchten", "alpha": 4e-05, "n": 1.2},
                              "conductivity": {"along": 1e-04}}}],
    "ground": {"column": {"height": 1.0, "cells": 20, "layers": [{"soil": "soil"}]}},
    "surface": {"zones": [{"name": "rain", "time": [0], "rate": [1e-04]}]},
    "initial": {"flow": "saturation", "saturation": 0.85},
    "probes": [{"name": "top", "place": [0, 0.995]}, {"name": "base", "place": [0, 0]}]
})";

/// A gentle bank of soil that deforms.
inline const char* const bank_text = R"({
    "name": "bank",
    "soils": [{"name": "soil", "dryDensity": 1800, "porosity": 0.4,
               "hydraulics": {"retention": {"model": "vanGenuchten", "alpha": 4e-05, "n": 1.2},
                              "conductivity": {"along": 1e-04}},
               "solid": {"model": "mohrCoulomb", "youngModulus": 10e6, "poissonRatio": 0.3,
                         "strength": {"model": "vanapalli", "cohesion": 12e3, "frictionAngle": 30}}}],
    "ground": {"section": {"terrain": [[0, 6], [4, 6], [10, 3], [14, 3]], "base": [[0, 0], [14, 0]],
                           "layers": [{"soil": "soil"}], "columnWidth": 2, "surfaceCellHeight": 0.4,
                           "gradedDepth": 0.8, "growth": 1.5, "largestCellHeight": 1.5}},
    "boundaries": [{"name": "base", "side": "base", "flow": "impermeable", "motion": "fixed"},
                   {"name": "left", "side": "left", "motion": "roller"},
                   {"name": "right", "side": "right", "motion": "roller"},
                   {"name": "water", "side": "right", "yTo": 1, "flow": "hydrostatic", "flowValue": {"value": [1]}}],
    "surface": {"zones": [{"name": "rain", "time": [0], "rate": [3e-06], "rainEnd": 86400}]},
    "initial": {"flow": "steady", "surfacePressure": -50e3},
    "probes": [{"name": "A", "place": [5, 4]}]
})";

inline Scene scene(const char* text) {
    talus_scene* out = nullptr;
    const talus_status status = talus_scene_from_json(text, -1, &out);
    REQUIRE_MESSAGE(status == TALUS_OK, talus_last_error());
    return Scene(out);
}

inline Engine engine(const char* text, const talus_options* options = nullptr) {
    talus_engine* out = nullptr;
    const talus_status status = talus_engine_create(scene(text).get(), options, &out);
    REQUIRE_MESSAGE(status == TALUS_OK, talus_last_error());
    return Engine(out);
}

inline int64_t hash(const Engine& engine) {
    int64_t hash = 0;
    REQUIRE(talus_engine_hash(engine.get(), &hash) == TALUS_OK);
    return hash;
}

inline talus_field view(const Engine& engine, const char* name) {
    talus_field field = TALUS_FIELD_INIT;
    REQUIRE_MESSAGE(talus_engine_view(engine.get(), name, &field) == TALUS_OK, talus_last_error());
    return field;
}

inline bool contains(const char* text, const char* part) { return std::string(text).find(part) != std::string::npos; }

}  // namespace host

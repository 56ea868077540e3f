// View, read, sample, probes, events: the calls that leave an engine as it is.
#include "handles.hpp"
#include "structs.hpp"

#include <cmath>
#include <span>

namespace talus::capi {
namespace {

talus_field field_of(const FieldView& view, int64_t epoch) {
    const int64_t value_size = view.type == DataType::float64 ? 8 : 4;
    talus_field field = TALUS_FIELD_INIT;
    field.type = static_cast<int32_t>(view.type);
    field.location = static_cast<int32_t>(view.location);
    field.rank = view.components == 1 ? 1 : 2;
    field.shape[0] = view.count;
    field.strides[0] = view.components * value_size;
    if (field.rank == 2) {
        field.shape[1] = view.components;
        field.strides[1] = value_size;
    }
    field.data = view.data;
    field.name = view.name;
    field.units = view.units;
    field.standard_name = view.standard_name;
    field.epoch = epoch;
    return field;
}

void copy(const FieldView& view, double* values) {
    const int64_t count = view.count * view.components;
    if (view.type == DataType::float64) {
        std::copy_n(static_cast<const double*>(view.data), count, values);
    } else {
        std::copy_n(static_cast<const int32_t*>(view.data), count, values);
    }
}

int32_t dimension(const Engine& run) { return run.scene().ground.kind == GroundKind::column ? 1 : 2; }

talus_status sample(const Engine& run, const char* field, std::span<const double> places, double* values) {
    const auto components = static_cast<size_t>(run.view(field).components);
    const size_t count = places.size() / static_cast<size_t>(dimension(run)) * components;
    return run.sample(field, places, {values, count}) ? TALUS_OK : TALUS_OUTSIDE;
}

void check(const talus_raster& raster, int32_t dimension) {
    require_count(raster.columns, "raster.columns", 1);
    require_count(raster.rows, "raster.rows", 1);
    if (dimension != 2) {
        throw Error(Status::invalid_argument, "a column has no raster: sample it at places");
    }
    const bool finite =
        std::isfinite(raster.x) && std::isfinite(raster.y) && std::isfinite(raster.dx) && std::isfinite(raster.dy);
    if (!finite || raster.dx == 0 || raster.dy == 0) {
        throw Error(Status::invalid_argument, "raster.x, y, dx and dy must be finite, dx and dy not 0");
    }
}

std::vector<double> places_of(const talus_raster& raster) {
    std::vector<double> places;
    places.reserve(2 * static_cast<size_t>(raster.columns) * static_cast<size_t>(raster.rows));
    for (int32_t row = 0; row < raster.rows; ++row) {
        for (int32_t column = 0; column < raster.columns; ++column) {
            places.push_back(raster.x + column * raster.dx);
            places.push_back(raster.y + row * raster.dy);
        }
    }
    return places;
}

void require_values(int64_t count, int64_t needed, const char* field) {
    if (count != needed) {
        throw Error(Status::invalid_argument, "count is " + std::to_string(count) + "; " + field + " has " +
                                                  std::to_string(needed) + " values here");
    }
}

template <class Vector>
const auto& element(const Vector& vector, int64_t index, const char* name) {
    if (index < 0 || index >= static_cast<int64_t>(vector.size())) {
        throw Error(Status::invalid_argument, std::string(name) + " is " + std::to_string(index) + "; there are " +
                                                  std::to_string(vector.size()));
    }
    return vector[static_cast<size_t>(index)];
}

}  // namespace
}  // namespace talus::capi

using namespace talus;
using namespace talus::capi;

const char* talus_engine_error(talus_engine* engine) {
    return is_engine(engine) ? engine->message.text() : "the handle is not one of an engine";
}

talus_status talus_engine_describe(talus_engine* engine, const char** json) {
    return on_engine(engine, [&](talus_engine& self) {
        require(json, "json");
        *json = self.run->describe().c_str();
        return talus_status{TALUS_OK};
    });
}

talus_status talus_engine_field_count(talus_engine* engine, int32_t* count) {
    return on_engine(engine, [&](talus_engine& self) {
        require(count, "count");
        *count = static_cast<int32_t>(self.run->field_names().size());
        return talus_status{TALUS_OK};
    });
}

talus_status talus_engine_field_name(talus_engine* engine, int32_t index, const char** name) {
    return on_engine(engine, [&](talus_engine& self) {
        require(name, "name");
        const std::vector<std::string> names = self.run->field_names();
        *name = self.run->view(element(names, index, "index")).name;
        return talus_status{TALUS_OK};
    });
}

talus_status talus_engine_view(talus_engine* engine, const char* field, talus_field* out) {
    return on_engine(engine, [&](talus_engine& self) {
        require(field, "field");
        require(out, "out");
        write_struct(field_of(self.run->view(field), self.run->epoch()), out, "TALUS_FIELD_INIT");
        return talus_status{TALUS_OK};
    });
}

talus_status talus_engine_read(talus_engine* engine, const char* field, int64_t count, double* values) {
    return on_engine(engine, [&](talus_engine& self) {
        require(field, "field");
        const FieldView view = self.run->view(field);
        require_values(count, view.count * view.components, field);
        require(values, "values");
        copy(view, values);
        return talus_status{TALUS_OK};
    });
}

talus_status talus_engine_sample(talus_engine* engine, const char* field, int64_t count, const double* places,
                                 double* values) {
    return on_engine(engine, [&](talus_engine& self) {
        require(field, "field");
        require_count(count, "count", 1);
        require(places, "places");
        require(values, "values");
        const auto numbers = static_cast<size_t>(count * dimension(*self.run));
        return sample(*self.run, field, {places, numbers}, values);
    });
}

talus_status talus_engine_sample_raster(talus_engine* engine, const char* field, const talus_raster* raster,
                                        int64_t count, double* values) {
    return on_engine(engine, [&](talus_engine& self) {
        require(field, "field");
        require(raster, "raster");
        require(values, "values");
        const talus_raster checked = read_struct(raster, "TALUS_RASTER_INIT");
        check(checked, dimension(*self.run));
        const int64_t pixels = int64_t{checked.rows} * checked.columns;
        require_values(count, pixels * self.run->view(field).components, field);
        return sample(*self.run, field, places_of(checked), values);
    });
}

talus_status talus_engine_probe(talus_engine* engine, const char* name, int32_t* probe) {
    return on_engine(engine, [&](talus_engine& self) {
        require(name, "name");
        require(probe, "probe");
        *probe = self.run->probe(name);
        return talus_status{TALUS_OK};
    });
}

talus_status talus_engine_add_probe(talus_engine* engine, const char* name, double x, double y, int32_t* probe) {
    return on_engine(engine, [&](talus_engine& self) {
        require(name, "name");
        const int32_t added = self.run->add_probe(name, {x, y});
        if (probe != nullptr) {
            *probe = added;
        }
        return talus_status{TALUS_OK};
    });
}

talus_status talus_engine_probe_history(talus_engine* engine, int32_t probe, const char* quantity, talus_history* out) {
    return on_engine(engine, [&](talus_engine& self) {
        require(quantity, "quantity");
        require(out, "out");
        const std::span<const double> value = self.run->probe_history(probe, quantity);
        talus_history history = TALUS_HISTORY_INIT;
        history.count = static_cast<int64_t>(value.size());
        history.time = self.run->probe_times().data();
        history.value = value.data();
        history.epoch = self.run->epoch();
        write_struct(history, out, "TALUS_HISTORY_INIT");
        return talus_status{TALUS_OK};
    });
}

talus_status talus_engine_event_count(talus_engine* engine, int64_t* count) {
    return on_engine(engine, [&](talus_engine& self) {
        require(count, "count");
        *count = static_cast<int64_t>(self.run->events().size());
        return talus_status{TALUS_OK};
    });
}

talus_status talus_engine_event(talus_engine* engine, int64_t index, talus_event* out) {
    return on_engine(engine, [&](talus_engine& self) {
        require(out, "out");
        const Event& found = element(self.run->events(), index, "index");
        talus_event event = TALUS_EVENT_INIT;
        event.kind = static_cast<int32_t>(found.kind);
        event.time = found.time;
        event.x = found.place[0];
        event.y = found.place[1];
        event.value = found.value;
        event.message = found.message.c_str();
        write_struct(event, out, "TALUS_EVENT_INIT");
        return talus_status{TALUS_OK};
    });
}

talus_status talus_engine_hash(talus_engine* engine, int64_t* hash) {
    return on_engine(engine, [&](talus_engine& self) {
        require(hash, "hash");
        *hash = static_cast<int64_t>(self.run->hash());
        return talus_status{TALUS_OK};
    });
}

// Format: VTK XML, inline binary data: base64 of the number of bytes (UInt64) and the values.
// https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html
#include "runner/vtu.hpp"

#include "runner/atomic_file.hpp"

#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <span>

namespace runner {
namespace {

static_assert(std::endian::native == std::endian::little, "the files say byte_order LittleEndian");

/// Values of a field, rows of components.
struct Rows {
    std::vector<double> values;
    int64_t components = 1;
};

std::string number(double value) {
    std::array<char, 32> text{};
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

void append_base64(std::string& text, std::span<const unsigned char> bytes) {
    static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    text.reserve(text.size() + (bytes.size() + 2) / 3 * 4);
    for (size_t i = 0; i < bytes.size(); i += 3) {
        const size_t have = std::min<size_t>(3, bytes.size() - i);
        uint32_t group = 0;
        for (size_t k = 0; k < 3; ++k) {
            group = group << 8 | (k < have ? bytes[i + k] : 0u);
        }
        for (size_t k = 0; k < 4; ++k) {
            text += k <= have ? digits[group >> (18 - 6 * k) & 63u] : '=';
        }
    }
}

template <class Value>
void append_data(std::string& text, const std::vector<Value>& values) {
    const uint64_t size = values.size() * sizeof(Value);
    std::vector<unsigned char> bytes(sizeof size + size);
    std::memcpy(bytes.data(), &size, sizeof size);
    if (size > 0) {
        std::memcpy(bytes.data() + sizeof size, values.data(), size);
    }
    append_base64(text, bytes);
}

/// Names of a tensor's components; a vector has none and ParaView calls them X, Y, Z.
std::string component_names(int64_t components) {
    return components == 4 ? R"( ComponentName0="xx" ComponentName1="yy" ComponentName2="zz" ComponentName3="xy")" : "";
}

template <class Value>
void append_array(std::string& text, const std::string& name, const char* type, const std::vector<Value>& values,
                  int64_t components = 1) {
    text += std::string("<DataArray type=\"") + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
            std::to_string(components) + "\" NumberOfTuples=\"" +
            std::to_string(static_cast<int64_t>(values.size()) / components) + "\"" + component_names(components) +
            " format=\"binary\">\n";
    append_data(text, values);
    text += "\n</DataArray>\n";
}

int64_t rows_of(const talus_field& field) { return field.shape[0]; }
int64_t components_of(const talus_field& field) { return field.rank == 1 ? 1 : field.shape[1]; }

template <class Value>
std::vector<Value> values_of(const talus_field& field) {
    const auto* first = static_cast<const Value*>(field.data);
    return {first, first + rows_of(field) * components_of(field)};
}

/// Two components x, y become x, y, 0. In a column the one component of a place is y.
Rows in_three_dimensions(const talus_field& field) {
    const std::vector<double> values = values_of<double>(field);
    const auto components = static_cast<size_t>(components_of(field));
    Rows rows{{}, 3};
    rows.values.reserve(3 * values.size() / components);
    for (size_t i = 0; i < values.size(); i += components) {
        rows.values.insert(rows.values.end(), {components == 1 ? 0 : values[i], values[i + components - 1], 0});
    }
    return rows;
}

void append_fields(std::string& text, const Engine& engine, const char* location,
                   const std::vector<std::string>& names) {
    text += std::string("<") + location + ">\n";
    for (const std::string& name : names) {
        const talus_field field = view(engine, name);
        if (field.type == TALUS_INT32) {
            append_array(text, name, "Int32", values_of<int32_t>(field), components_of(field));
        } else if (components_of(field) == 2) {
            append_array(text, name, "Float64", in_three_dimensions(field).values, 3);
        } else {
            append_array(text, name, "Float64", values_of<double>(field), components_of(field));
        }
    }
    text += std::string("</") + location + ">\n";
}

/// How cells join nodes, in VTK's terms.
struct Cells {
    std::vector<int32_t> nodes;
    std::vector<int32_t> ends;  ///< one past each cell's last place in nodes
    std::vector<uint8_t> types;
};

uint8_t vtk_type(int32_t nodes) {
    constexpr uint8_t vertex = 1, line = 3, triangle = 5, quad = 9;
    return nodes == 1 ? vertex : nodes == 2 ? line : nodes == 3 ? triangle : quad;
}

Cells mesh_cells(const Engine& engine) {
    const std::vector<int32_t> starts = values_of<int32_t>(view(engine, "cell_start"));
    Cells cells{values_of<int32_t>(view(engine, "cell_nodes")), {starts.begin() + 1, starts.end()}, {}};
    for (size_t i = 1; i < starts.size(); ++i) {
        cells.types.push_back(vtk_type(starts[i] - starts[i - 1]));
    }
    return cells;
}

Cells vertices(int64_t count) {
    Cells cells;
    for (int32_t i = 0; i < count; ++i) {
        cells.nodes.push_back(i);
        cells.ends.push_back(i + 1);
        cells.types.push_back(vtk_type(1));
    }
    return cells;
}

std::string vtu(const Engine& engine, const std::string& position, const Cells& cells,
                const std::vector<std::string>& point_data, const std::vector<std::string>& cell_data) {
    const Rows places = in_three_dimensions(view(engine, position));
    std::string text =
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
        "<UnstructuredGrid>\n<FieldData>\n";
    append_array(text, "TimeValue", "Float64", std::vector<double>{talus_engine_time(engine.get())});
    text += "</FieldData>\n<Piece NumberOfPoints=\"" + std::to_string(places.values.size() / 3) +
            "\" NumberOfCells=\"" + std::to_string(cells.types.size()) + "\">\n";
    append_fields(text, engine, "PointData", point_data);
    append_fields(text, engine, "CellData", cell_data);
    text += "<Points>\n";
    append_array(text, "Points", "Float64", places.values, 3);
    text += "</Points>\n<Cells>\n";
    append_array(text, "connectivity", "Int32", cells.nodes);
    append_array(text, "offsets", "Int32", cells.ends);
    append_array(text, "types", "UInt8", cells.types);
    text += "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
    return text;
}

std::vector<std::string> fields_at(const Json& description, const std::string& location, const std::string& position) {
    std::vector<std::string> names;
    for (const Json& field : description.at("fields")) {
        if (field.at("location") == location && field.at("name") != position) {
            names.push_back(field.at("name"));
        }
    }
    return names;
}

std::string file_name(const std::string& series, size_t index) {
    const std::string digits = std::to_string(index);
    return series + "_" + std::string(digits.size() < 4 ? 4 - digits.size() : 0, '0') + digits + ".vtu";
}

}  // namespace

FieldFiles::FieldFiles(std::filesystem::path folder) : folder_(std::move(folder)) {
    std::filesystem::create_directories(folder_ / "fields");
}

void FieldFiles::write(const Engine& engine) {
    const double time = talus_engine_time(engine.get());
    const Json description = describe(engine);
    if (description.at("nodes") != 0) {
        add(ground_, time,
            vtu(engine, "node_position", mesh_cells(engine), fields_at(description, "node", "node_position"),
                fields_at(description, "cell", "")));
    }
    const Cells points = vertices(rows_of(view(engine, "point_position")));
    add(points_, time, vtu(engine, "point_position", points, fields_at(description, "point", "point_position"), {}));
}

void FieldFiles::add(Series& series, double time, const std::string& vtu) {
    write_file(folder_ / "fields" / file_name(series.name, series.times.size()), vtu);
    series.times.push_back(time);
    std::string pvd =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n<Collection>\n";
    for (size_t i = 0; i < series.times.size(); ++i) {
        pvd += "<DataSet timestep=\"" + number(series.times[i]) + "\" part=\"0\" file=\"fields/" +
               file_name(series.name, i) + "\"/>\n";
    }
    write_file(folder_ / (series.name + ".pvd"), pvd + "</Collection>\n</VTKFile>\n");
}

}  // namespace runner

#include "ground/gmsh_file.hpp"

#include "error.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <set>

namespace talus {
namespace {

/// Words of the text, one after the other, with the line they are on.
class Words {
public:
    Words(std::string_view text, const std::string& name) : text_(text), name_(name) {}

    [[nodiscard]] int32_t line() const { return line_; }
    [[noreturn]] void fail(const std::string& what) const {
        throw Error(Status::invalid_scene, gmsh_place(name_, line_) + what);
    }

    /// The next word, empty at the end of the text.
    std::string_view next() {
        while (at_ < text_.size() && is_space(text_[at_])) step();
        const size_t first = at_;
        while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
        return text_.substr(first, at_ - first);
    }

    template <class Number>
    Number number(const char* what) {
        const std::string_view word = next();
        Number value{};
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (word.empty()) fail(std::string("the file ends where ") + what + " should stand");
        if (error != std::errc{} || end != word.data() + word.size())
            fail(std::string(what) + ": " + shown(word) + " is not a number in range");
        return value;
    }
    double real(const char* what) {
        const auto value = number<double>(what);
        if (!std::isfinite(value)) fail(std::string(what) + ": must be finite");
        return value;
    }
    int64_t integer(const char* what) {
        const auto value = number<int64_t>(what);
        if (value == std::numeric_limits<int64_t>::min())
            fail(std::string(what) + ": is out of range");  // has no opposite
        return value;
    }
    int64_t count(const char* what) {
        const int64_t value = integer(what);
        if (value < 0) fail(std::string(what) + ": is " + std::to_string(value) + ", must not be negative");
        return value;
    }
    void skip(int64_t words, const char* what) {
        for (int64_t i = 0; i < words; ++i) {
            if (next().empty()) fail(std::string("the file ends where ") + what + " should stand");
        }
    }

    /// The text between the next two quotation marks, on one line.
    std::string quoted() {
        while (at_ < text_.size() && text_[at_] != '"' && text_[at_] != '\n') ++at_;
        const size_t end = at_ < text_.size() ? text_.find_first_of("\"\n", at_ + 1) : std::string_view::npos;
        if (end == std::string_view::npos || text_[at_] != '"' || text_[end] != '"')
            fail("a name in quotation marks should stand here");
        const std::string_view inside = text_.substr(at_ + 1, end - at_ - 1);
        at_ = end + 1;
        return std::string(inside);
    }

    void expect(std::string_view expected) {
        const std::string_view word = next();
        if (word != expected) fail(shown(word) + " stands where " + std::string(expected) + " should");
    }

    void skip_to(const std::string& expected) {
        const int32_t first_line = line_;
        for (std::string_view word = next(); word != expected; word = next()) {
            if (!word.empty()) continue;
            line_ = first_line;
            fail("the section that begins here has no " + expected);
        }
    }

    /// A word for a message: hostile files may hold very long ones, and bytes that are no text.
    static std::string shown(std::string_view word) {
        std::string text = word.empty() ? "the end of the file" : "'" + std::string(word.substr(0, 40)) + "'";
        std::replace_if(
            text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
        return text;
    }

private:
    static bool is_space(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }
    void step() {
        if (text_[at_] == '\n') ++line_;
        ++at_;
    }

    std::string_view text_;
    const std::string& name_;
    size_t at_ = 0;
    int32_t line_ = 1;
};

/// Number of nodes of an element type; 1 for points.
int32_t element_size(int64_t type, const Words& words) {
    if (type == 15) return 1;
    if (type >= 1 && type <= 3) return static_cast<int32_t>(type) + 1;
    words.fail("element type " + std::to_string(type) +
               ": only points (15), 2-node lines (1), 3-node triangles (2) and 4-node quads (3) "
               "are allowed: a plane mesh of first order");
}

void add_element(int64_t type, int64_t owner, Words& words, GmshFile& file) {
    GmshElement element{words.line(), element_size(type, words), owner, {}};
    for (int32_t i = 0; i < element.size; ++i)
        element.nodes[static_cast<size_t>(i)] = words.integer("a node of an element");
    if (element.size > 1) file.elements.push_back(element);
}

void read_physical_names(Words& words, GmshFile& file) {
    const int64_t count = words.count("number of physical names");
    for (int64_t i = 0; i < count; ++i) {
        const int64_t dimension = words.integer("dimension of a physical name");
        const int64_t tag = words.integer("tag of a physical name");
        file.physical_names[{dimension, tag}] = {words.line(), words.quoted()};
    }
}

// --- 2.2 -------------------------------------------------------------------------------------------------------------

void read_nodes_2(Words& words, GmshFile& file) {
    const int64_t count = words.count("number of nodes");
    for (int64_t i = 0; i < count; ++i) {
        const int64_t tag = words.integer("number of a node");
        const double x = words.real("x of a node");
        const double y = words.real("y of a node");
        file.nodes.push_back({tag, x, y, words.real("z of a node")});
    }
}

void read_elements_2(Words& words, GmshFile& file) {
    const int64_t count = words.count("number of elements");
    for (int64_t i = 0; i < count; ++i) {
        words.integer("number of an element");
        const int64_t type = words.integer("type of an element");
        const int64_t tags = words.count("number of tags of an element");
        const int64_t group = tags > 0 ? words.integer("physical group of an element") : 0;
        words.skip(tags - 1, "a tag of an element");
        add_element(type, group, words, file);
    }
}

// --- 4.1 -------------------------------------------------------------------------------------------------------------

void read_entity(int64_t dimension, Words& words, GmshFile& file) {
    const int64_t tag = words.integer("tag of an entity");
    words.skip(dimension == 0 ? 3 : 6, "the bounds of an entity");
    const int64_t groups = words.count("number of physical groups of an entity");
    if (groups > 1 && (dimension == 1 || dimension == 2)) {
        words.fail((dimension == 1 ? "curve " : "surface ") + std::to_string(tag) + " belongs to " +
                   std::to_string(groups) + " physical groups; one is allowed");
    }
    file.entity_group[{dimension, tag}] = groups == 1 ? words.integer("physical group of an entity") : 0;
    if (groups > 1) words.skip(groups, "a physical group of an entity");
    if (dimension > 0) words.skip(words.count("number of bounds of an entity"), "a bound of an entity");
}

void read_entities_4(Words& words, GmshFile& file) {
    int64_t count[4];
    for (int64_t& entities : count) entities = words.count("number of entities");
    for (int64_t dimension = 0; dimension < 4; ++dimension) {
        for (int64_t i = 0; i < count[dimension]; ++i) read_entity(dimension, words, file);
    }
}

void read_nodes_4(Words& words, GmshFile& file) {
    const int64_t blocks = words.count("number of node blocks");
    words.skip(3, "the numbers of nodes");
    for (int64_t block = 0; block < blocks; ++block) {
        const int64_t dimension = words.count("dimension of an entity");
        words.integer("tag of an entity");
        const int64_t parameters = words.integer("whether nodes have parameters") != 0 ? dimension : 0;
        const int64_t count = words.count("number of nodes of a block");
        const size_t first = file.nodes.size();
        for (int64_t i = 0; i < count; ++i) file.nodes.push_back({words.integer("number of a node"), 0, 0, 0});
        for (size_t i = first; i < file.nodes.size(); ++i) {
            file.nodes[i].x = words.real("x of a node");
            file.nodes[i].y = words.real("y of a node");
            file.nodes[i].z = words.real("z of a node");
            words.skip(parameters, "a parameter of a node");
        }
    }
}

void read_elements_4(Words& words, GmshFile& file) {
    const int64_t blocks = words.count("number of element blocks");
    words.skip(3, "the numbers of elements");
    for (int64_t block = 0; block < blocks; ++block) {
        words.integer("dimension of an entity");
        const int64_t entity = words.integer("tag of an entity");
        const int64_t type = words.integer("type of the elements of a block");
        const int64_t count = words.count("number of elements of a block");
        for (int64_t i = 0; i < count; ++i) {
            words.integer("number of an element");
            add_element(type, entity, words, file);
        }
    }
}

// --- sections --------------------------------------------------------------------------------------------------------

void read_format(Words& words, GmshFile& file) {
    const std::string_view version = words.next();
    if (version != "2.2" && version != "4.1") {
        words.fail("MSH version " + Words::shown(version) + "; 2.2 and 4.1 are allowed (gmsh -format msh41)");
    }
    file.has_entities = version == "4.1";
    if (words.integer("file type") != 0) words.fail("the file is binary; only ASCII is allowed (gmsh without -bin)");
    words.integer("data size");
}

void read_section(std::string_view section, Words& words, GmshFile& file) {
    const std::string end = "$End" + std::string(section.substr(1));
    if (section == "$MeshFormat") {
        read_format(words, file);
    } else if (section == "$PhysicalNames") {
        read_physical_names(words, file);
    } else if (section == "$Entities" && file.has_entities) {
        read_entities_4(words, file);
    } else if (section == "$Nodes") {
        file.has_entities ? read_nodes_4(words, file) : read_nodes_2(words, file);
    } else if (section == "$Elements") {
        file.has_entities ? read_elements_4(words, file) : read_elements_2(words, file);
    } else {
        return words.skip_to(end);
    }
    words.expect(end);
}

}  // namespace

std::string gmsh_place(const std::string& name, int32_t line) {
    return "ground.mesh.file: " + name + ", line " + std::to_string(line) + ": ";
}

GmshFile parse_gmsh(std::string_view text, const std::string& name) {
    GmshFile file;
    file.name = name;
    Words words(text, file.name);
    std::set<std::string, std::less<>> seen;
    for (std::string_view section = words.next(); !section.empty(); section = words.next()) {
        if (section.front() != '$') words.fail(Words::shown(section) + " stands where a section ($...) should begin");
        if (seen.empty() && section != "$MeshFormat")
            words.fail("the first section is " + Words::shown(section) + ", must be $MeshFormat: not a Gmsh mesh file");
        const bool first_time = seen.emplace(section).second;
        if (!first_time && section != "$Comments") words.fail("a second section " + Words::shown(section));
        read_section(section, words, file);
    }
    if (!seen.contains("$PhysicalNames"))
        words.fail("the file has no section $PhysicalNames; name the physical surfaces after the scene's soils");
    for (const char* section : {"$MeshFormat", "$Nodes", "$Elements"}) {
        if (!seen.contains(section)) words.fail("the file has no section " + std::string(section));
    }
    std::sort(file.nodes.begin(), file.nodes.end(), [](const GmshNode& a, const GmshNode& b) { return a.tag < b.tag; });
    const auto twice = std::adjacent_find(file.nodes.begin(), file.nodes.end(),
                                          [](const GmshNode& a, const GmshNode& b) { return a.tag == b.tag; });
    if (twice != file.nodes.end()) words.fail("node " + std::to_string(twice->tag) + " is given twice in $Nodes");
    return file;
}

}  // namespace talus

#include "ground_scenes.hpp"

#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

using namespace talus;

namespace {

/// Two squares beside each other, the right one in two triangles of clay, one of them clockwise; node 50 is used by no
/// cell. The line through the middle is named but not on the boundary, and the surface's right half belongs to a road.
const std::string legacy = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$Comments
anything: $Nodes
$EndComments
$PhysicalNames
5
1 7 "surface"
1 8 "road, 2 lanes"
1 9 "interface"
2 1 "sand"
2 2 "clay"
$EndPhysicalNames
$Nodes
7
10 0 0 0
20 1 0 0
30 2 0 0
40 0 1.0e+00 0
50 5 5 5
60 1 1 0
70 2 1 0
$EndNodes
$Elements
8
1 15 2 0 1 10
2 1 2 7 1 60 40
3 1 2 8 2 60 70
4 1 2 9 3 20 60
5 1 2 0 3 10 20
6 3 2 1 1 10 20 60 40
7 2 3 2 2 0 20 30 70
8 2 2 2 2 20 60 70
$EndElements
)";

const std::string modern = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
5
1 7 "surface"
1 8 "road, 2 lanes"
1 9 "interface"
2 1 "sand"
2 2 "clay"
$EndPhysicalNames
$Entities
1 4 2 0
1 0 0 0 0
1 0 1 0 1 1 0 1 -7 2 1 -2
2 1 1 0 2 1 0 1 8 0
3 1 0 0 1 1 0 1 9 2 1 -2
4 0 0 0 1 0 0 0 0
1 0 0 0 1 1 0 1 1 0
2 1 0 0 2 1 0 1 2 4 1 2 3 4
$EndEntities
$Nodes
3 7 10 70
0 1 0 1
10
0 0 0
1 1 1 3
40
60
50
0 1 0 0.5
1 1 0 0.75
5 5 5 0.1
2 1 0 3
20
30
70
1 0 0
2 0 0
2 1 0
$EndNodes
$Elements
6 7 2 8
1 1 1 1
2 60 40
1 2 1 1
3 60 70
1 3 1 1
4 20 60
1 4 1 1
5 10 20
2 1 3 1
6 10 20 60 40
2 2 2 2
7 20 30 70
8 20 60 70
$EndElements
)";

/// A file of the test's own, removed with it.
class TemporaryFile {
public:
    explicit TemporaryFile(const std::string& text) : path_(std::filesystem::temp_directory_path() / name()) {
        write(text);
    }
    ~TemporaryFile() { std::filesystem::remove(path_); }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    void write(const std::string& text) const { std::ofstream(path_, std::ios::binary | std::ios::trunc) << text; }
    [[nodiscard]] std::string path() const { return path_.string(); }

private:
    static std::string name() { return "talus_test_" + std::to_string(std::random_device{}()) + ".msh"; }
    std::filesystem::path path_;
};

Scene file_scene(const std::string& path) {
    Scene scene = scene_with_soils({"clay", "sand"});
    scene.ground.kind = GroundKind::mesh;
    scene.ground.mesh.file = path;
    return scene;
}

Mesh mesh_of(const std::string& text) { return build_mesh(file_scene(TemporaryFile(text).path())); }

std::string replaced(std::string text, const std::string& old, const std::string& by) {
    const size_t at = text.find(old);
    REQUIRE(at != std::string::npos);
    return text.replace(at, old.size(), by);
}

int32_t line_of(const std::string& text, const std::string& part) {
    return 1 + static_cast<int32_t>(
                   std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(text.find(part)), '\n'));
}

}  // namespace

TEST_CASE("Gmsh 2.2 and 4.1 files give the same mesh, soils and sides") {
    for (const std::string& text : {legacy, modern, replaced(legacy, "1.0e+00", "1")}) {
        const Mesh mesh = mesh_of(text);
        CHECK(mesh.node_count() == 6);
        REQUIRE(mesh.cell_count() == 3);
        CHECK(mesh.cell_soil == std::vector<int32_t>{1, 0, 0});
        CHECK(soil_area(mesh, 1) == doctest::Approx(1));
        CHECK(soil_area(mesh, 0) == doctest::Approx(1));
        for (int32_t cell = 0; cell < 3; ++cell) CHECK(cell_area(mesh, cell) > 0);
        CHECK(mesh.sides == std::vector<std::string>{"base", "left", "right", "surface", "road, 2 lanes", "interface"});
        CHECK(side_length(mesh, "base") == doctest::Approx(2));
        CHECK(side_length(mesh, "left") == doctest::Approx(1));
        CHECK(side_length(mesh, "right") == doctest::Approx(1));
        CHECK(side_length(mesh, "surface") == doctest::Approx(1));
        CHECK(side_length(mesh, "road, 2 lanes") == doctest::Approx(1));
        CHECK(side_length(mesh, "interface") == 0);
    }
}

TEST_CASE("line ends of other systems are read") {
    std::string text;
    for (const char c : legacy) text += c == '\n' ? "\r\n" : std::string(1, c);
    CHECK(mesh_of(text).cell_count() == 3);
}

TEST_CASE("physical lines win over geometry") {
    const Mesh mesh = mesh_of(replaced(legacy, "\"road, 2 lanes\"", "\"left\""));
    CHECK(side_length(mesh, "left") == doctest::Approx(2));
    CHECK(side_length(mesh, "surface") == doctest::Approx(1));
}

TEST_CASE("the slope in triangles is the paper's number of them") {
    Scene scene = scene_with_soils({"soil"});
    scene.ground.kind = GroundKind::mesh;
    scene.ground.mesh.file = TALUS_SOURCE_DIR "/samples/scenes/slope_triangles.msh";
    const Mesh mesh = build_mesh(scene);
    CHECK(mesh.cell_count() == 3858);
    CHECK(mesh.cell_nodes.size() == 3 * 3858);
    CHECK(soil_area(mesh, 0) == doctest::Approx(1200).epsilon(1e-9));
    CHECK(side_length(mesh, "base") == doctest::Approx(60).epsilon(1e-9));
    CHECK(side_length(mesh, "left") == doctest::Approx(30).epsilon(1e-9));
    CHECK(side_length(mesh, "right") == doctest::Approx(10).epsilon(1e-9));
    CHECK(side_length(mesh, "surface") == doctest::Approx(40 + std::sqrt(800.)).epsilon(1e-9));
    CHECK(mesh.sides.size() == 4);
}

TEST_CASE("wrong Gmsh files are refused, naming file, line and what is allowed") {
    const auto check = [](const std::string& text, const std::string& at, const std::string& what) {
        const TemporaryFile file(text);
        const std::string message = build_failure(file_scene(file.path()));
        INFO(message);
        CHECK(mentions(message, "ground.mesh.file: " + file.path()));
        if (!at.empty()) CHECK(mentions(message, ", line " + std::to_string(line_of(text, at)) + ": "));
        CHECK(mentions(message, what));
    };
    const auto change = [&](const std::string& text, const std::string& old, const std::string& by,
                            const std::string& what) { check(replaced(text, old, by), by, what); };
    change(legacy, "2.2 0 8", "3.0 0 8", "MSH version '3.0'; 2.2 and 4.1 are allowed");
    change(legacy, "2.2 0 8", "2.2 1 8", "the file is binary; only ASCII is allowed");
    change(legacy, "6 3 2 1 1 10 20 60 40", "6 16 2 1 1 10 20 60 40 1 2 3 4", "element type 16");
    change(legacy, "7 2 3 2 2 0 20 30 70", "7 4 2 2 2 20 30 70 60", "element type 4");
    change(legacy, "7 2 3 2 2 0 20 30 70", "7 2 3 2 2 0 20 30 71", "node 71, which $Nodes does not list");
    change(legacy, "7 2 3 2 2 0 20 30 70", "7 2 2 0 2 20 30 70", "the cell belongs to no physical surface");
    change(legacy, "7 2 3 2 2 0 20 30 70", "7 2 0 20 30 70", "the cell belongs to no physical surface");
    change(legacy, "7 2 3 2 2 0 20 30 70", "7 2 2 5 2 20 30 70", "physical surface 5 has no name");
    change(legacy, "7 2 3 2 2 0 20 30 70", "7 2 -3 2 2 20 30 70", "must not be negative");
    change(legacy, "2 2 \"clay\"", "2 2 \"peat\"", "no soil is called 'peat'; the scene's soils are: clay, sand");
    change(legacy, "2 2 \"clay\"", "2 2 clay", "a name in quotation marks");
    change(legacy, "60 1 1 0", "60 1 one 0", "'one' is not a number");
    change(legacy, "60 1 1 0", "60 1 nan 0", "must be finite");
    change(legacy, "60 1 1 0", "60 1 1e999 0", "not a number in range");
    change(legacy, "60 1 1 0", "60 1 1,5 0", "'1,5' is not a number");
    check(replaced(legacy, "$Elements\n8", "$Elements\n9"), "$EndElements", "'$EndElements' is not a number");
    check(replaced(legacy, "$Elements\n8", "$Elements\n-1"), "-1", "must not be negative");
    check(replaced(legacy, "$Elements\n8", "$Elements\n7"), "8 2 2 2 2", "stands where $EndElements should");
    change(legacy, "$Comments", "$Mine", "the section that begins here has no $EndMine");
    change(legacy, "$Comments", "Comments", "stands where a section ($...) should begin");
    check(replaced(legacy, "$Nodes\n7", "$Nodes\n99999999999999"), "", "number of a node: '$EndNodes' is not a number");
    check(replaced(legacy, "60 1 1 0", "60 1 1 0.5"), "6 3 2 1 1 10", "z = 0.5; a section lies in the plane z = 0");
    check(replaced(legacy, "50 5 5 5", "60 5 5 5"), "", "node 60 is given twice");
    check(legacy + legacy, "", "a second section '$MeshFormat'");
    check("", "", "no section $PhysicalNames");
    check("solid cube", "solid", "stands where a section");
    check(replaced(legacy, "3 1 2 8 2 60 70", "3 1 2 8 2 60 40"), "3 1 2 8",
          "the line belongs to the sides surface and road, 2 lanes");
    check(replaced(legacy, "8 2 2 2 2 20 60 70", "8 2 2 2 2 20 30 70"), "", "on the same side of the edge");

    change(modern, "2 1 0 0 2 1 0 1 2 4 1 2 3 4", "2 1 0 0 2 1 0 2 1 2 4 1 2 3 4",
           "surface 2 belongs to 2 physical groups; one is allowed");
    check(replaced(modern, "2 2 2 2\n", "2 5 2 2\n"), "7 20 30 70", "entity 5, which $Entities does not list");
    change(modern, "1 -7 2 1 -2", "1 -9223372036854775808 2 1 -2", "out of range");
    check(replaced(modern, "1 1 1 3\n", "1 1 1 99999999999999\n"), "", "is not a number");
}

TEST_CASE("a mesh file that cannot be read is named") {
    CHECK(mentions(build_failure(file_scene("/nowhere/slope.msh")), "cannot read '/nowhere/slope.msh'"));
    CHECK(mentions(build_failure(file_scene(std::filesystem::temp_directory_path().string())), "ground.mesh.file: "));
}

TEST_CASE("no damage to a Gmsh file does more than give a message or another mesh") {
    std::mt19937 random(1);
    const TemporaryFile file("");
    const std::string digits = "0123456789-. \n$eE\"\xff";
    for (const std::string& text : {legacy, modern}) {
        for (size_t length = 0; length + 1 < text.size(); length += 7) {
            file.write(text.substr(0, length));
            CHECK_FALSE(build_failure(file_scene(file.path())).empty());
        }
        for (int32_t i = 0; i < 1000; ++i) {
            std::string damaged = text;
            for (size_t k = 0; k < 1 + random() % 4; ++k)
                damaged[random() % damaged.size()] = digits[random() % digits.size()];
            file.write(damaged);
            (void)build_failure(file_scene(file.path()));
        }
    }
}

#include "ground/build.hpp"

#include "error.hpp"
#include "ground/builders.hpp"

namespace talus {

int32_t find_soil(const Scene& scene, const std::string& name, const std::string& path) {
    std::string known;
    for (size_t i = 0; i < scene.soils.size(); ++i) {
        if (scene.soils[i].name == name) return static_cast<int32_t>(i);
        known += (i == 0 ? "" : ", ") + scene.soils[i].name;
    }
    throw Error(Status::invalid_scene, path + ": no soil is called '" + name + "'; the scene's soils are: " + known);
}

Mesh build_mesh(const Scene& scene) {
    switch (scene.ground.kind) {
        case GroundKind::column: return build_column(scene);
        case GroundKind::section: return build_section(scene);
        case GroundKind::mesh: return scene.ground.mesh.file.empty() ? build_imported(scene) : build_gmsh(scene);
    }
    throw Error(Status::invalid_scene, "ground: unknown kind");
}

}  // namespace talus

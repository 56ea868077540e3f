#include "error.hpp"
#include "ground/builders.hpp"
#include "ground/quality.hpp"
#include "ground/sides.hpp"

namespace talus {

Mesh build_imported(const Scene& scene) {
    const MeshGround& given = scene.ground.mesh;
    Mesh mesh;
    mesh.position = given.position;
    mesh.cell_start = given.cell_start;
    mesh.cell_nodes = given.cell_nodes;
    mesh.cell_soil = given.cell_soil;
    check_mesh(mesh, "ground.mesh");
    for (size_t cell = 0; cell < mesh.cell_soil.size(); ++cell) {
        if (mesh.cell_soil[cell] < static_cast<int32_t>(scene.soils.size())) continue;
        throw Error(Status::invalid_scene,
                    "ground.mesh.cellSoil[" + std::to_string(cell) + "]: is " + std::to_string(mesh.cell_soil[cell]) +
                        "; the scene's soils are numbered 0 to " + std::to_string(scene.soils.size() - 1));
    }
    set_sides(mesh);
    return mesh;
}

}  // namespace talus

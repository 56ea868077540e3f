#include "error.hpp"
#include "ground/builders.hpp"

namespace talus {

Mesh build_gmsh(const Scene& scene) { throw Error(Status::io, scene.ground.mesh.file + ": cannot be read yet"); }

}  // namespace talus

// Field files for ParaView: a VTU file an output time, and a PVD file that lists them with their times.
#pragma once

#include "runner/host.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace runner {

/// Two series in a folder: ground.pvd with the mesh and the fields at its nodes and cells, points.pvd with the material points
/// and theirs. A dynamic ground has no mesh, and the second alone. Positions are the current ones. Vectors have three components, as ParaView wants them; tensors four, named.
class FieldFiles {
public:
    FieldFiles(std::filesystem::path folder, const Json& description);

    /// Adds the engine's fields as they are now.
    void write(const Engine& engine);

private:
    struct Series {
        std::string name;
        std::vector<double> times;
    };
    void add(Series& series, double time, const std::string& vtu);

    std::filesystem::path folder_;
    bool has_mesh_;
    std::vector<std::string> node_fields_;
    std::vector<std::string> cell_fields_;
    std::vector<std::string> point_fields_;
    Series ground_{"ground", {}};
    Series points_{"points", {}};
};

}  // namespace runner

// Field files for ParaView: a VTU file an output time, and a PVD file that lists them with their times.
#pragma once

#include "runner/host.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace runner {

/// Two series in a folder: ground.pvd with the mesh and the fields at its nodes and cells, points.pvd with the material points
/// and theirs. A dynamic ground has no mesh, and the second alone; so has one that moves after it failed. Positions are the current ones. Vectors have three components, as ParaView wants them; tensors four, named.
class FieldFiles {
public:
    explicit FieldFiles(std::filesystem::path folder);

    /// Adds the engine's fields as they are now.
    void write(const Engine& engine);

private:
    struct Series {
        std::string name;
        std::vector<double> times;
    };
    void add(Series& series, double time, const std::string& vtu);

    std::filesystem::path folder_;
    Series ground_{"ground", {}};
    Series points_{"points", {}};
};

}  // namespace runner

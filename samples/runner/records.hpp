// What a run leaves as numbers: report.json and probes.csv.
#pragma once

#include "runner/host.hpp"

#include <string>

namespace runner {

[[nodiscard]] Json report_json(const talus_step_report& report);
[[nodiscard]] Json events_json(const Engine& engine);

/// A row a step: time and every quantity of every probe of the scene. Empty without probes.
[[nodiscard]] std::string probes_csv(const Engine& engine, const Json& description);

/// The state's hash as text, 16 hexadecimal digits.
[[nodiscard]] std::string hash_text(const Engine& engine);

}  // namespace runner

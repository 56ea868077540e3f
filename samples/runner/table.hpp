// What a run or a scene comes to, for people: on standard output.
#pragma once

#include "runner/host.hpp"

namespace runner {

void print_description(const Json& description);
void print_table(const Json& description, const talus_step_report& last, const Json& events, double wall);

}  // namespace runner

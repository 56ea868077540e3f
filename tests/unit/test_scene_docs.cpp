// docs/scenes.md is written from the schema.
#include <doctest/doctest.h>
#include <cstdlib>
#include <string>

TEST_CASE("the scene reference is what the schema says") {
    const std::string check = "/usr/bin/python3 " TALUS_SOURCE_DIR "/docs/generate_scenes.py --check";
    CHECK(std::system(check.c_str()) == 0);
}

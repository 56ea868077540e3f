// The calls that need no handle.
#include "guard.hpp"

#include <capnp/common.h>
#include <sundials/sundials_config.h>
#include <Eigen/Core>

#define TALUS_TEXT_OF(value) #value
#define TALUS_TEXT(value) TALUS_TEXT_OF(value)
#define TALUS_VERSION \
    TALUS_TEXT(TALUS_VERSION_MAJOR) "." TALUS_TEXT(TALUS_VERSION_MINOR) "." TALUS_TEXT(TALUS_VERSION_PATCH)

#ifdef NDEBUG
#define TALUS_BUILD "release"
#else
#define TALUS_BUILD "debug"
#endif

const char* talus_version(void) { return TALUS_VERSION; }

int32_t talus_abi(void) { return TALUS_ABI; }

const char* talus_build_info(void) {
    return "{\"version\": \"" TALUS_VERSION "\", \"abi\": " TALUS_TEXT(
        TALUS_ABI) ", \"build\": \"" TALUS_BUILD "\", \"compiler\": \"" __VERSION__
                   "\", \"eigen\": \"" TALUS_TEXT(EIGEN_WORLD_VERSION) "." TALUS_TEXT(EIGEN_MAJOR_VERSION) "." TALUS_TEXT(
                       EIGEN_MINOR_VERSION) "\", \"sundials\": \"" SUNDIALS_VERSION
                                            "\", \"capnproto\": \"" TALUS_TEXT(CAPNP_VERSION_MAJOR) "." TALUS_TEXT(
                                                CAPNP_VERSION_MINOR) "." TALUS_TEXT(CAPNP_VERSION_MICRO) "\"}";
}

const char* talus_status_name(talus_status status) {
    switch (status) {
        case TALUS_OK: return "ok";
        case TALUS_CANCELLED: return "cancelled";
        case TALUS_OUT_OF_RAIN: return "out_of_rain";
        case TALUS_OUTSIDE: return "outside";
        case TALUS_ENDED_EARLY: return "ended_early";
        case TALUS_INVALID_HANDLE: return "invalid_handle";
        case TALUS_INVALID_ARGUMENT: return "invalid_argument";
        case TALUS_INVALID_SCENE: return "invalid_scene";
        case TALUS_UNKNOWN_NAME: return "unknown_name";
        case TALUS_NOT_CONVERGED: return "not_converged";
        case TALUS_OUT_OF_MEMORY: return "out_of_memory";
        case TALUS_INPUT_OUTPUT: return "input_output";
        case TALUS_INTERNAL: return "internal";
        case TALUS_BUSY: return "busy";
        default: return "unknown";
    }
}

const char* talus_last_error(void) { return talus::capi::thread_message().text(); }

// What the opaque handles point to, and how an entry gets at it.
#pragma once

#include "guard.hpp"

#include <atomic>
#include <memory>
#include <vector>

struct talus_scene {
    int64_t magic;
    std::atomic<int64_t> references{1};
    std::shared_ptr<const talus::Scene> scene;
};

struct talus_engine {
    int64_t magic;
    std::atomic_flag busy;              ///< a call is running: a second one would be a data race
    const std::fenv_t* host = nullptr;  ///< the host's floating-point environment, of the call that is running
    talus::capi::Message message;
    talus_options options{};
    std::vector<double> last_rate;  ///< m/s, the last good one pushed to each zone; NaN: none
    int64_t rain_substitutions = 0;
    std::unique_ptr<talus::Engine> run;
};

namespace talus::capi {

inline constexpr int64_t scene_magic = 0x656e656373756c74;   // "tluscene"
inline constexpr int64_t engine_magic = 0x656e69676e656c74;  // "tlengine"

[[nodiscard]] bool is_engine(const talus_engine* engine) noexcept;

/// Throw invalid_handle when a handle is NULL, destroyed or no handle at all.
void require_scene(const talus_scene* scene);
void require_engine(const talus_engine* engine);

/// Marks an engine as being in a call; throws busy when it is in one already.
class Busy {
public:
    explicit Busy(talus_engine& engine);
    ~Busy() { engine_.busy.clear(std::memory_order_release); }
    Busy(const Busy&) = delete;
    Busy& operator=(const Busy&) = delete;

private:
    talus_engine& engine_;
};

/// Runs `call(talus_engine&)`, which returns a status and may throw, on a valid handle that no other call uses.
template <class Call>
talus_status on_engine(talus_engine* engine, Call call) {
    std::fenv_t host;
    Message* message = nullptr;
    return guarded(host, message, [&] {
        require_engine(engine);
        const Busy busy(*engine);
        engine->host = &host;
        message = &engine->message;
        return call(*engine);
    });
}

}  // namespace talus::capi

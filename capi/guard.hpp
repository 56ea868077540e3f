// One guard at each entry: no exception leaves it, the host's floating-point environment comes back as it was, and the text
// of a failure is kept where talus_last_error and talus_engine_error find it.
#pragma once

#include "engine.hpp"
#include "talus/talus.h"

#include <cfenv>
#include <cstdint>
#include <string_view>

namespace talus::capi {

/// The text of a failure. Of fixed size, so that keeping it cannot fail and unloading the library leaves nothing behind.
class Message {
public:
    /// Keeps the text; one that is too long ends in "...".
    void set(std::string_view text) noexcept;
    [[nodiscard]] const char* text() const noexcept { return text_; }

private:
    char text_[16384] = "";
};

/// Of the last failed call of this thread.
Message& thread_message() noexcept;

/// The default floating-point environment (nearest rounding, no traps, no flush to zero) while it lives.
class FloatingPointGuard {
public:
    explicit FloatingPointGuard(std::fenv_t& host) noexcept : host_(host) {
        std::fegetenv(&host_);
        std::fesetenv(FE_DFL_ENV);
    }
    ~FloatingPointGuard() { std::fesetenv(&host_); }
    FloatingPointGuard(const FloatingPointGuard&) = delete;
    FloatingPointGuard& operator=(const FloatingPointGuard&) = delete;

private:
    std::fenv_t& host_;
};

/// The host's floating-point environment while one of its callbacks runs.
class HostFloatingPoint {
public:
    explicit HostFloatingPoint(const std::fenv_t& host) noexcept {
        std::fegetenv(&ours_);
        std::fesetenv(&host);
    }
    ~HostFloatingPoint() { std::fesetenv(&ours_); }
    HostFloatingPoint(const HostFloatingPoint&) = delete;
    HostFloatingPoint& operator=(const HostFloatingPoint&) = delete;

private:
    std::fenv_t ours_{};
};

/// Turns the exception being handled into a status; its text goes to this thread's message and, if there is one, to another.
talus_status keep_failure(Message* message);

/// Not inlined, so that no arithmetic of the call moves out of the guard.
template <class Call>
[[gnu::noinline]] talus_status out_of_line(Call& call) {
    return call();
}

/// Runs a call that returns a status and may throw. `host` is the floating-point environment of the host meanwhile; `message`,
/// which the call may set, is where the text of a failure goes besides this thread's message.
template <class Call>
talus_status guarded(std::fenv_t& host, Message*& message, Call call) {
    const FloatingPointGuard floating_point(host);
    try {
        return out_of_line(call);
    } catch (...) {
        return keep_failure(message);
    }
}

template <class Call>
talus_status guarded(Call call) {
    std::fenv_t host;
    Message* message = nullptr;
    return guarded(host, message, call);
}

/// Throws invalid_argument when a pointer that must be given is NULL.
void require(const void* pointer, const char* name);
/// Throws invalid_argument when a count is not between least and what any memory could hold.
void require_count(int64_t count, const char* name, int64_t least);

}  // namespace talus::capi

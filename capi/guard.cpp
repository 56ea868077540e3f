#include "guard.hpp"

#include <cxxabi.h>
#include <algorithm>
#include <cstring>
#include <new>

namespace talus::capi {

void Message::set(std::string_view text) noexcept {
    constexpr std::string_view cut = "...";
    const size_t room = sizeof(text_) - 1;
    const size_t length = std::min(text.size(), room);
    std::memcpy(text_, text.data(), length);
    text_[length] = '\0';
    if (text.size() > room) {
        std::memcpy(text_ + room - cut.size(), cut.data(), cut.size());
    }
}

Message& thread_message() noexcept {
    thread_local Message message;
    return message;
}

namespace {

talus_status keep(Status status, std::string_view text, Message* message) noexcept {
    thread_message().set(text);
    if (message != nullptr) {
        message->set(text);
    }
    return static_cast<talus_status>(status);
}

}  // namespace

talus_status keep_failure(Message* message) {
    try {
        throw;
    } catch (const abi::__forced_unwind&) {
        throw;  // the host ends this thread (pthread_cancel): swallowing that would abort the process
    } catch (const Error& error) {
        return keep(error.status, error.what(), message);
    } catch (const std::bad_alloc&) {
        return keep(Status::out_of_memory, "out of memory", message);
    } catch (const std::exception& error) {
        return keep(Status::internal, error.what(), message);
    } catch (...) {
        return keep(Status::internal, "an exception of unknown type, from a callback of the host?", message);
    }
}

void require(const void* pointer, const char* name) {
    if (pointer == nullptr) {
        throw Error(Status::invalid_argument, std::string(name) + " is NULL");
    }
}

void require_count(int64_t count, const char* name, int64_t least) {
    constexpr int64_t most = int64_t{1} << 48;
    if (count < least || count > most) {
        throw Error(Status::invalid_argument, std::string(name) + " is " + std::to_string(count) +
                                                  ", which must be at least " + std::to_string(least) +
                                                  (count > most ? " and fit into memory" : ""));
    }
}

}  // namespace talus::capi

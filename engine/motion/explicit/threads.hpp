// The threads of an engine's motion.
#pragma once

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <cstddef>
#include <cstdint>
#include <memory>

namespace talus {

class Threads {
public:
    Threads() = default;
    explicit Threads(int32_t count) : arena_(count > 1 ? std::make_shared<tbb::task_arena>(count) : nullptr) {}

    /// use(i) for every i below count, at the same time.
    template <class Use>
    void for_each(size_t count, const Use& use) const {
        if (!arena_) {
            for (size_t i = 0; i < count; ++i) use(i);
        } else {
            arena_->execute([&] { tbb::parallel_for(size_t{0}, count, use); });
        }
    }

private:
    std::shared_ptr<tbb::task_arena> arena_;  // none: the calling thread alone
};

}  // namespace talus

// The host's process is its own: floating-point environment, locale, standard streams, threads.
#include "capi_host.hpp"

#include <fcntl.h>
#include <unistd.h>
#include <cfenv>
#include <clocale>
#include <cstdio>
#include <locale>
#include <thread>
#include <vector>

namespace {

constexpr int trapped = FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW;

int64_t run(const char* text, int steps) {
    const host::Engine engine = host::engine(text);
    for (int i = 0; i < steps; ++i) {
        REQUIRE_MESSAGE(talus_engine_step(engine.get(), 20, nullptr) == TALUS_OK, talus_last_error());
    }
    return host::hash(engine);
}

/// A decimal comma, as a German host has it; no such locale need be installed.
struct DecimalComma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
};

/// What is written to standard output and error meanwhile.
class Silence {
public:
    Silence() : file_(std::tmpfile()) {
        std::fflush(nullptr);
        for (const int stream : {1, 2}) {
            saved_[stream - 1] = dup(stream);
            dup2(fileno(file_), stream);
        }
    }
    ~Silence() { std::fclose(file_); }

    long written() {
        std::fflush(nullptr);
        for (const int stream : {1, 2}) {
            dup2(saved_[stream - 1], stream);
            close(saved_[stream - 1]);
        }
        return static_cast<long>(lseek(fileno(file_), 0, SEEK_END));
    }

private:
    std::FILE* file_;
    int saved_[2] = {};
};

}  // namespace

TEST_CASE("C API: a host that traps floating-point exceptions is not trapped, and gets its environment back") {
    const int64_t usual = run(host::bank_text, 3);
    std::fenv_t before;
    std::fegetenv(&before);
    std::feclearexcept(FE_ALL_EXCEPT);
    std::feraiseexcept(FE_INEXACT);
    std::fesetround(FE_UPWARD);
    feenableexcept(trapped);
    struct Seen {
        int traps = 0;
        int rounding = 0;
    } seen;
    talus_options options = TALUS_OPTIONS_INIT;
    options.progress_user = &seen;
    options.progress = [](void* user, double) -> int32_t {
        *static_cast<Seen*>(user) = {fegetexcept(), std::fegetround()};
        return 0;
    };
    talus_engine* engine = nullptr;
    talus_scene* scene = nullptr;
    talus_status status = talus_scene_from_json(host::bank_text, -1, &scene);
    if (status == TALUS_OK) status = talus_engine_create(scene, &options, &engine);
    for (int i = 0; i < 3 && status == TALUS_OK; ++i) status = talus_engine_step(engine, 20, nullptr);
    const int traps = fegetexcept();
    const int rounding = std::fegetround();
    const int raised = std::fetestexcept(FE_ALL_EXCEPT);
    int64_t hash = 0;
    talus_engine_hash(engine, &hash);
    talus_engine_destroy(engine);
    talus_scene_release(scene);
    std::fesetenv(&before);

    CHECK(status == TALUS_OK);
    CHECK(traps == trapped);
    CHECK(rounding == FE_UPWARD);
    CHECK(raised == FE_INEXACT);
    CHECK(hash == usual);          // and the host's rounding mode is not ours
    CHECK(seen.traps == trapped);  // callbacks run in the host's environment
    CHECK(seen.rounding == FE_UPWARD);
}

TEST_CASE("C API: flush to zero, which a host's other library may have set, changes no bit") {
#if defined(__SSE__)
    const int64_t usual = run(host::bank_text, 3);
    const unsigned before = __builtin_ia32_stmxcsr();
    __builtin_ia32_ldmxcsr(before | 0x8040u);  // flush to zero, denormals are zero
    const int64_t flushed = run(host::bank_text, 3);
    const unsigned after = __builtin_ia32_stmxcsr();
    __builtin_ia32_ldmxcsr(before);
    CHECK(flushed == usual);
    CHECK((after & 0x8040u) == 0x8040u);
#endif
}

TEST_CASE("C API: a locale with decimal commas changes nothing and is not changed") {
    const int64_t usual = run(host::bank_text, 2);
    const std::locale before = std::locale::global(std::locale(std::locale::classic(), new DecimalComma));
    const char* c_locale = std::setlocale(LC_ALL, "de_DE.UTF-8");  // where there is one
    const int64_t comma = run(host::bank_text, 2);
    const host::Engine engine = host::engine(host::bank_text);
    const char* json = nullptr;
    CHECK(talus_engine_describe(engine.get(), &json) == TALUS_OK);
    CHECK(talus_engine_step(engine.get(), -1234.5, nullptr) == TALUS_INVALID_ARGUMENT);
    const bool plain = host::contains(talus_engine_error(engine.get()), "-1234.5");
    if (c_locale != nullptr) CHECK(std::string(std::setlocale(LC_NUMERIC, nullptr)) == "de_DE.UTF-8");
    std::setlocale(LC_ALL, "C");
    std::locale::global(before);
    CHECK(comma == usual);
    CHECK(plain);
}

TEST_CASE("C API: nothing is printed, not even in trouble") {
    Silence silence;
    {
        talus_scene* none = nullptr;
        talus_scene_from_json("{\"ground\": 1}", -1, &none);
        const host::Engine engine = host::engine(host::bank_text);
        talus_engine_step(engine.get(), -1, nullptr);
        talus_engine_step(engine.get(), 3600, nullptr);
        talus_engine_set_rain(engine.get(), 0, 1e-3);  // far more than the ground takes
        talus_engine_step(engine.get(), 1e6, nullptr);
        talus_engine_cancel(engine.get());
        talus_engine_step(engine.get(), 1, nullptr);
    }
    CHECK(silence.written() == 0);
}

TEST_CASE("C API: engines in several threads give the bits that each gives alone") {
    const int64_t column = run(host::column_text, 5);
    const int64_t bank = run(host::bank_text, 5);
    std::vector<int64_t> hashes(4);
    std::vector<std::thread> threads;
    for (size_t i = 0; i < hashes.size(); ++i) {
        threads.emplace_back([&hashes, i] { hashes[i] = run(i % 2 == 0 ? host::column_text : host::bank_text, 5); });
    }
    for (std::thread& thread : threads) thread.join();
    CHECK(hashes == std::vector<int64_t>{column, bank, column, bank});
}

TEST_CASE("C API: one scene serves engines in two threads") {
    const host::Scene scene = host::scene(host::bank_text);
    std::vector<int64_t> hashes(2);
    std::vector<std::thread> threads;
    for (int64_t& hash : hashes) {
        threads.emplace_back([&scene, &hash] {
            talus_engine* out = nullptr;
            REQUIRE(talus_engine_create(scene.get(), nullptr, &out) == TALUS_OK);
            const host::Engine engine(out);
            REQUIRE(talus_engine_step(out, 600, nullptr) == TALUS_OK);
            hash = host::hash(engine);
        });
    }
    for (std::thread& thread : threads) thread.join();
    CHECK(hashes[0] == hashes[1]);
}

TEST_CASE("C API: a hundred engines created, stepped and destroyed give the same bits") {
    const int64_t first = run(host::column_text, 1);
    for (int i = 0; i < 100; ++i) {
        if (const int64_t hash = run(host::column_text, 1); hash != first) CHECK(hash == first);
    }
}

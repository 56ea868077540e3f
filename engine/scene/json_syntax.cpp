#include "scene/json_syntax.hpp"

#include <charconv>
#include <cstddef>

namespace talus {
namespace {

constexpr int deepest = 50;

/// The number that four hexadecimal digits are, or -1.
int hexadecimal(std::string_view text, size_t at) {
    int number = 0;
    if (at + 4 > text.size()) return -1;
    const auto [end, error] = std::from_chars(&text[at], &text[at] + 4, number, 16);
    return error == std::errc() && end == &text[at] + 4 && text[at] != '-' ? number : -1;
}

bool is_surrogate(int unit) { return (unit & 0xf800) == 0xd800; }
bool is_high_surrogate(int unit) { return (unit & 0xfc00) == 0xd800; }
bool is_low_surrogate(int unit) { return unit >= 0 && (unit & 0xfc00) == 0xdc00; }

void append_utf8(std::string& text, int code) {
    const auto append = [&](int byte) { text += static_cast<char>(byte); };
    if (code < 0x80) {
        if (code == '"' || code == '\\') append('\\');
        append(code);
    } else if (code < 0x800) {
        append(0xc0 | code >> 6);
    } else if (code < 0x10000) {
        append(0xe0 | code >> 12);
    } else {
        append(0xf0 | code >> 18);
        append(0x80 | (code >> 12 & 0x3f));
    }
    if (code >= 0x800) append(0x80 | (code >> 6 & 0x3f));
    if (code >= 0x80) append(0x80 | (code & 0x3f));
}

/// A recursive descent over the grammar of RFC 8259. Each function moves past what it accepts, or notes what it expected.
class Scan {
public:
    explicit Scan(std::string_view text) : text(text) {}

    std::string error() {
        if (value(0)) {
            skip_space();
            if (at == text.size()) return "";
            fail("the end of the text");
        }
        return where() + expected;
    }

private:
    bool value(int depth) {
        skip_space();
        switch (peek()) {
            case '{': return enclosed('}', "',' or '}'", depth, &Scan::member);
            case '[': return enclosed(']', "',' or ']'", depth, &Scan::value);
            case '"': return string();
            case 't': return word("true");
            case 'f': return word("false");
            case 'n': return word("null");
            default: return number();
        }
    }

    bool member(int depth) {
        skip_space();
        if (peek() != '"') return fail("a field's name in double quotes");
        if (!string()) return false;
        skip_space();
        if (!accept(':')) return fail("':'");
        return value(depth);
    }

    bool enclosed(char end, const char* between, int depth, bool (Scan::*item)(int)) {
        if (depth == deepest) return fail("no more than 50 nested arrays and objects");
        ++at;
        skip_space();
        if (accept(end)) return true;
        do {
            if (!(this->*item)(depth + 1)) return false;
            skip_space();
        } while (accept(','));
        return accept(end) || fail(between);
    }

    bool string() {
        for (++at; at < text.size(); ++at) {
            const char letter = text[at];
            if (letter == '"') {
                ++at;
                return true;
            }
            if (static_cast<unsigned char>(letter) < 0x20) return fail("no control character in a text");
            if (letter == '\\' && !escape()) return false;
        }
        return fail("the closing '\"' of a text");
    }

    /// Leaves `at` on the escape's last letter.
    bool escape() {
        ++at;
        if (peek() != 'u') {
            return std::string_view("\"\\/bfnrt").find(peek()) != std::string_view::npos ||
                   fail("an escape that JSON knows");
        }
        const int unit = hexadecimal(text, at + 1);
        if (unit < 0) return fail("four hexadecimal digits");
        if (unit < 0x20) return fail("no control character in a text");
        at += 4;
        if (!is_surrogate(unit)) return true;
        const bool pair =
            is_high_surrogate(unit) && text.substr(at + 1, 2) == "\\u" && is_low_surrogate(hexadecimal(text, at + 3));
        if (!pair) return fail("a pair of surrogates");
        at += 6;
        return true;
    }

    bool number() {
        const size_t start = at;
        accept('-');
        if (!accept('0') && !digits()) {
            at = start;
            return fail("a value: a number, text in double quotes, array, object, true, false or null");
        }
        if (accept('.') && !digits()) return fail("a digit");
        if (accept('e') || accept('E')) {
            if (!accept('+')) accept('-');
            if (!digits()) return fail("a digit");
        }
        return true;
    }

    bool digits() {
        const size_t start = at;
        while (peek() >= '0' && peek() <= '9') ++at;
        return at > start;
    }

    bool word(std::string_view expected_word) {
        if (text.substr(at, expected_word.size()) != expected_word) return fail("true, false or null");
        at += expected_word.size();
        return true;
    }

    void skip_space() {
        while (at < text.size() && std::string_view(" \t\r\n").find(text[at]) != std::string_view::npos) ++at;
    }

    [[nodiscard]] char peek() const { return at < text.size() ? text[at] : '\0'; }

    bool accept(char letter) {
        if (at >= text.size() || text[at] != letter) return false;
        ++at;
        return true;
    }

    bool fail(const char* what) {
        expected = what;
        return false;
    }

    [[nodiscard]] std::string where() const {
        size_t line = 1;
        size_t column = 1;
        for (const char letter : text.substr(0, at)) {
            column = letter == '\n' ? 1 : column + 1;
            if (letter == '\n') ++line;
        }
        return "line " + std::to_string(line) + ", column " + std::to_string(column) +
               (at < text.size() ? ": expected " : ": the text ends; expected ");
    }

    std::string_view text;
    size_t at = 0;
    std::string expected;
};

}  // namespace

std::string json_syntax_error(std::string_view text) { return Scan(text).error(); }

std::string without_unicode_escapes(std::string_view text) {
    std::string result;
    result.reserve(text.size());
    for (size_t at = 0; at < text.size();) {
        if (text[at] != '\\') {
            result += text[at++];
        } else if (text[at + 1] != 'u') {
            result += text.substr(at, 2);
            at += 2;
        } else {
            const int unit = hexadecimal(text, at + 2);
            const bool pair = is_high_surrogate(unit);
            append_utf8(result, pair ? 0x10000 + ((unit & 0x3ff) << 10) + (hexadecimal(text, at + 8) & 0x3ff) : unit);
            at += pair ? 12 : 6;
        }
    }
    return result;
}

}  // namespace talus

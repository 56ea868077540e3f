#include "scene/problems.hpp"

#include <algorithm>
#include <cctype>

namespace talus {
namespace {

constexpr size_t longest_list = 100;

std::string letters(const std::string& name) {
    std::string result;
    for (const char letter : name) {
        const auto byte = static_cast<unsigned char>(letter);
        if (std::isalnum(byte) != 0) result += static_cast<char>(std::tolower(byte));
    }
    return result;
}

/// Levenshtein's distance: the least number of letters inserted, removed or replaced.
size_t distance(const std::string& a, const std::string& b) {
    std::vector<size_t> row(b.size() + 1);
    for (size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (size_t i = 1; i <= a.size(); ++i) {
        size_t diagonal = std::exchange(row[0], i);
        for (size_t j = 1; j <= b.size(); ++j) {
            const size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = std::exchange(row[j], std::min({row[j] + 1, row[j - 1] + 1, replaced}));
        }
    }
    return row.back();
}

}  // namespace

std::string joined(const std::vector<std::string>& names, const char* separator) {
    std::string result;
    for (const std::string& name : names) result += (result.empty() ? "" : separator) + name;
    return result;
}

std::string nearest(const std::string& wrong, const std::vector<std::string>& names) {
    if (wrong.size() > 100) return "";
    const std::string sought = letters(wrong);
    std::string best;
    size_t least = std::min(sought.size(), sought.size() / 3 + 2);  // something must be the same
    for (const std::string& name : names) {
        const size_t apart = distance(sought, letters(name));
        if (apart >= least) continue;
        least = apart;
        best = name;
    }
    return best;
}

void Problems::add(std::string problem) {
    if (++count <= longest_list) first.push_back(std::move(problem));
}

std::vector<std::string> Problems::list() const {
    std::vector<std::string> result = first;
    if (count > longest_list) result.push_back("and " + std::to_string(count - longest_list) + " more problems");
    return result;
}

}  // namespace talus

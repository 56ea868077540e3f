// What loads the skeleton and answers its motion: the water in its pores. The equilibrium is then that of both.
#pragma once

#include "motion/loads.hpp"

#include <optional>
#include <span>

namespace talus {

class Companion {
public:
    virtual ~Companion() = default;

    /// From where the skeleton alone would go next, under the loads as they are (nodes x dimension, m), to where both go.
    virtual void guide(std::span<double> direction) = 0;

    /// Goes `length` of that way, which the skeleton has gone already; 0 is where guide() began. Returns the loads there, none where it
    /// cannot go.
    virtual std::optional<Loads> follow(double length) = 0;

    /// What it does on the whole of that way with what it disagrees with the skeleton, J: falls to zero as the two come to agree.
    [[nodiscard]] virtual double power() const = 0;

    [[nodiscard]] virtual bool agrees() const = 0;
};

}  // namespace talus

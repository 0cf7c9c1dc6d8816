// Numbers of a checkpoint, read one after another: what is missing, or no number of anything, is refused.
#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "common/vectors.hpp"

namespace crumple::shell {

class Saved {
public:
    explicit Saved(const std::vector<double>& values) : next_(values.data()), end_(values.data() + values.size()) {}

    double number() {
        if (next_ == end_) refuse();
        return *next_++;
    }
    Vec3 vector() {
        const double x = number(), y = number();
        return {x, y, number()};
    }
    // whole number from `first` on, one of so many
    std::int64_t whole(std::int64_t first, std::size_t many) {
        const double value = number();
        if (!(value >= double(first) && value < double(first) + double(many)) || value != std::floor(value)) refuse();
        return std::int64_t(value);
    }
    // number of something below a limit
    std::size_t index(std::size_t limit) { return std::size_t(whole(0, limit)); }
    // how many records of so many numbers follow
    std::size_t count(std::size_t each) { return index(std::size_t(end_ - next_) / each + 1); }
    void copy(std::vector<double>& to) {
        for (double& x : to) x = number();
    }
    // everything was read
    void finish() const {
        if (next_ != end_) refuse();
    }

private:
    [[noreturn]] static void refuse() { throw std::invalid_argument("the checkpoint is damaged, or belongs to another model"); }
    const double *next_, *end_;
};

}  // namespace crumple::shell

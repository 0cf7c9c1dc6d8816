// Sequential reader of the numbers in a checkpoint; missing or invalid numbers are refused.
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
    // integer in [first, first + many)
    std::int64_t whole(std::int64_t first, std::size_t many) {
        const double value = number();
        if (!(value >= double(first) && value < double(first) + double(many)) || value != std::floor(value)) refuse();
        return std::int64_t(value);
    }
    // index below a limit
    std::size_t index(std::size_t limit) { return std::size_t(whole(0, limit)); }
    // number of records, of `each` numbers, that follow
    std::size_t count(std::size_t each) { return index(std::size_t(end_ - next_) / each + 1); }
    void copy(std::vector<double>& to) {
        for (double& x : to) x = number();
    }
    // checks that everything has been read
    void finish() const {
        if (next_ != end_) refuse();
    }

private:
    [[noreturn]] static void refuse() { throw std::invalid_argument("the checkpoint is damaged, or belongs to another model"); }
    const double *next_, *end_;
};

}  // namespace crumple::shell

// Copies between NumPy arrays and vectors: the core keeps its own memory.
#pragma once
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstdint>
#include <initializer_list>
#include <vector>

namespace crumple::shell {

using In = nanobind::ndarray<const double, nanobind::c_contig, nanobind::device::cpu>;
using InIndex = nanobind::ndarray<const std::uint32_t, nanobind::c_contig, nanobind::device::cpu>;
using InBits = nanobind::ndarray<const std::uint8_t, nanobind::c_contig, nanobind::device::cpu>;
using Array = nanobind::ndarray<nanobind::numpy, double>;

inline Array to_array(std::vector<double> values, std::initializer_list<std::size_t> shape) {
    auto* kept = new std::vector<double>(std::move(values));
    nanobind::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<double>*>(p); });
    return Array(kept->data(), shape, owner);
}

template <class A> auto to_vector(const A& a) {
    using T = std::remove_const_t<typename A::Scalar>;
    return std::vector<T>(a.data(), a.data() + a.size());
}

}  // namespace crumple::shell

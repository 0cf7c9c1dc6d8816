// What the bindings share: copies between NumPy arrays and vectors (the core keeps its own memory), checks of what
// Python hands over, and work without the interpreter's lock.
#pragma once
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

namespace crumple {

template <class T, class... Options> using InOf = nanobind::ndarray<const T, nanobind::c_contig, nanobind::device::cpu, Options...>;
using In = InOf<double>;
using InIndex = InOf<std::uint32_t>;
using InBits = InOf<std::uint8_t>;
using InNumbers = InOf<std::int64_t, nanobind::ndim<1>>;
template <class T> using ArrayOf = nanobind::ndarray<nanobind::numpy, T>;
using Array = ArrayOf<double>;

template <class T = double> ArrayOf<T> to_array(std::vector<T> values, const std::vector<std::size_t>& shape) {
    auto* kept = new std::vector<T>(std::move(values));
    nanobind::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
    return ArrayOf<T>(kept->data(), shape.size(), shape.data(), owner);
}

template <class A> auto to_vector(const A& a) {
    using T = std::remove_const_t<typename A::Scalar>;
    return std::vector<T>(a.data(), a.data() + a.size());
}

// The columns of a record, all of one shape, as one array (columns, shape): one object is cheaper to make than many.
template <class R> Array stacked(const R& record, std::initializer_list<std::size_t> shape) {
    std::vector<double> values;
    std::vector<std::size_t> whole{0};
    whole.insert(whole.end(), shape);
    R::each([&](const char*, auto column) {
        values.insert(values.end(), (record.*column).begin(), (record.*column).end());
        whole[0]++;
    });
    return to_array(std::move(values), whole);
}

// names of the columns of a record, in the order of `stacked`
template <class R> nanobind::list column_names() {
    nanobind::list names;
    R::each([&](const char* name, auto) { names.append(name); });
    return names;
}

inline void require(bool ok, const char* what) {
    if (!ok) throw nanobind::value_error(what);
}

// Rows of what varies from variant to variant, (count, ...); none: nothing does.
using Rows = std::optional<In>;

inline const double* rows(const Rows& given, std::size_t count, std::size_t each, const char* what) {
    if (!given) return nullptr;
    require(given->size() == count * each && given->ndim() > 0 && given->shape(0) == count, what);
    return given->data();
}

// Runs work(ask) while others may use the interpreter; `ask` calls `poll`, and is empty where that is None.
template <class Work> auto unlocked(nanobind::handle poll, Work work) {
    std::function<bool(double)> ask;
    if (!poll.is_none()) {
        ask = [poll](double value) {
            nanobind::gil_scoped_acquire locked;
            return nanobind::cast<bool>(poll(value));
        };
    }
    nanobind::gil_scoped_release released;
    return work(ask);
}

}  // namespace crumple

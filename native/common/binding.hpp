// Shared by the bindings: copies between NumPy arrays and vectors (the kernels own their memory), checks of the arguments
// from Python, and work with the interpreter lock (GIL) released.
#pragma once
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <typeinfo>
#include <initializer_list>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/machine.hpp"

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

// All columns of a record, each of this shape, as one array (columns, *shape) in the order of `column_names`.  Creating an array
// for every column would take longer than a short run.
template <class R> Array columns(const R& record, std::initializer_list<std::size_t> shape) {
    std::vector<std::size_t> whole{0};
    whole.insert(whole.end(), shape);
    std::vector<double> values;
    R::each([&](const char*, auto column) {
        whole[0]++;
        values.insert(values.end(), (record.*column).begin(), (record.*column).end());
    });
    return to_array(std::move(values), whole);
}

template <class R> nanobind::list column_names() {
    nanobind::list names;
    R::each([&](const char* name, auto) { names.append(name); });
    return names;
}

inline void require(bool ok, const char* what) {
    if (!ok) throw nanobind::value_error(what);
}

// times at which the states of the runs of a batch are kept
inline void require_sample_times(const std::vector<double>& times, double end) {
    for (std::size_t i = 0; i < times.size(); i++) {
        require(times[i] >= 0 && times[i] <= end && (i == 0 || times[i - 1] < times[i]), "times must increase from 0 to the end");
    }
}

// Converts a Python object to a C++ type; `name` identifies it in the message if it has another type.
template <class T> T as(nanobind::handle given, const std::string& name) {
    try {
        return nanobind::cast<T>(given);
    } catch (const std::bad_cast&) {
        throw nanobind::type_error((name + " has the wrong type or shape").c_str());
    }
}

inline std::string name_of_entry(const char* key) { return std::string("'") + key + "'"; }
inline std::string name_of_entry(int place) { return "entry " + std::to_string(place) + " of a tuple"; }

// Entry of a mapping by key, or of a tuple by index.
template <class T, class Holder, class Key> T entry(const Holder& holder, Key key) {
    return as<T>(nanobind::object(holder[key]), name_of_entry(key));
}

// Values that differ between variants, one row per variant, (count, ...); none if all variants share the model's value.
using Rows = std::optional<In>;

inline const double* rows(const Rows& given, std::size_t count, std::size_t each, const char* what) {
    if (!given) return nullptr;
    require(given->size() == count * each && given->ndim() > 0 && given->shape(0) == count, what);
    return given->data();
}

// A state with a flag: a thread works on it with the interpreter lock released.  The flag changes only while the lock is held.
template <class State> struct Used : State {
    using State::State;
    bool busy = false;
};

// Marks a state as in use while this object lives.
class Busy {
public:
    template <class State> explicit Busy(Used<State>& state) : busy_(state.busy) {
        if (busy_) throw std::runtime_error("this run is at work in another thread, or in what it calls");
        busy_ = true;
    }
    ~Busy() { busy_ = false; }
    Busy(const Busy&) = delete;
    Busy& operator=(const Busy&) = delete;

private:
    bool& busy_;
};

// Wraps a function of a state so that it refuses a state on which another thread works.
template <class State, class Result, class... Arguments> auto alone(Result (*function)(State&, Arguments...)) {
    return [function](Used<std::remove_const_t<State>>& state, Arguments... arguments) {
        const Busy busy(state);
        return function(state, std::forward<Arguments>(arguments)...);
    };
}

inline void require_settings(double accuracy, double minimum_step, double maximum_step, int parts = 1) {
    require(parts >= 1, "a step has at least one part");
    require(accuracy > 0 && std::isfinite(accuracy), "the accuracy must be positive");
    require(minimum_step > 0 && std::isfinite(minimum_step), "the smallest step must be positive");
    require(maximum_step >= minimum_step, "the largest step must not be below the smallest");
}

inline void require_times(const std::vector<double>& times, double now) {
    require(!times.empty(), "at least one output time is needed");
    for (std::size_t i = 0; i < times.size(); i++) {
        require(std::isfinite(times[i]) && times[i] >= (i > 0 ? times[i - 1] : 0.0), "output times are finite and do not fall");
    }
    require(times.back() >= now * (1 - 1e-9), "the last output time lies in the past");
}

// Breaks: times at which a step must end.
inline void require_breaks(const std::vector<double>& breaks) {
    for (std::size_t i = 0; i < breaks.size(); i++) {
        require(std::isfinite(breaks[i]) && (i == 0 || breaks[i] > breaks[i - 1]), "breaks are finite and increase");
    }
}

inline void require_finite(std::initializer_list<double> numbers, const char* what) {
    for (const double x : numbers) require(std::isfinite(x), what);
}

inline void require_step(double h) { require(h > 0 && std::isfinite(h), "a step is positive"); }

// A None in a list of models arrives as a null pointer.
template <class T> void require_all(const std::vector<T*>& given) {
    for (const T* one : given) require(one != nullptr, "a model is missing");
}

// Checks that a tuple has this number of fields.
inline nanobind::tuple fields(nanobind::handle given, std::size_t number, const char* what) {
    require(nanobind::isinstance<nanobind::tuple>(given), what);
    const auto found = nanobind::cast<nanobind::tuple>(given);
    require(found.size() == number, what);
    return found;
}

// Runs work(ask) while others may use the interpreter, with tiny numbers as zero; `ask` calls `poll`, and is empty where that is None.
template <class Work> auto unlocked(nanobind::handle poll, Work work) {
    std::function<bool(double)> ask;
    if (!poll.is_none()) {
        ask = [poll](double value) {
            const TinyAsZero usual(false);
            nanobind::gil_scoped_acquire locked;
            return nanobind::cast<bool>(poll(value));
        };
    }
    nanobind::gil_scoped_release released;
    const TinyAsZero fast;
    return work(ask);
}

}  // namespace crumple

// Result columns that both multibody kernels record, by name.
//
// Every record lists its columns once, in `each`, with a pointer to the member; storage, batches and bindings are generated
// from that list.  A column has one row per output time (in a batch: one row per run); a summary has a single row per run.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace crumple {

// Outcome of a run; crumple._core.outcome has the same values.
enum class Outcome { complete, step_collapsed, not_finite, cancelled, refused, unheld, limit_load, stalled };

// Energies of the whole model [J], (rows).  `slowed`: kinetic energy that quasi-static stages removed.
template <class T> struct EnergyRecord {
    std::vector<T> kinetic, elastic, dissipated, damped, stop, spring, contact, friction, external_work, slowed;
    template <class F> static void each(F f) {
        using R = EnergyRecord;
        f("kinetic", &R::kinetic), f("elastic", &R::elastic), f("dissipated", &R::dissipated), f("damped", &R::damped);
        f("stop", &R::stop), f("spring", &R::spring), f("contact", &R::contact), f("friction", &R::friction);
        f("external_work", &R::external_work), f("slowed", &R::slowed);
    }
};

// Energies of every hinge [J], (rows, hinges); `dissipated` includes its damper and its stops.
template <class T> struct HingeEnergyRecord {
    std::vector<T> dissipated, elastic, stop;
    template <class F> static void each(F f) {
        using R = HingeEnergyRecord;
        f("dissipated", &R::dissipated), f("elastic", &R::elastic), f("stop", &R::stop);
    }
};

// Histories of every component of every hinge, (rows, components): rotations [rad] and moments [N m], or displacements [m]
// and forces [N].
template <class T> struct ComponentRecord {
    std::vector<T> rotation, rate, plastic, moment, capacity;
    template <class F> static void each(F f) {
        using R = ComponentRecord;
        f("rotation", &R::rotation), f("rate", &R::rate), f("plastic", &R::plastic), f("moment", &R::moment);
        f("capacity", &R::capacity);
    }
};

// Summary of every hinge at the end of a run, (hinges); times of events that did not happen are NaN.
template <class T> struct HingeSummary {
    std::vector<T> rotation_max, moment_max, opening_time, rest_time, turning, energy, fracture_time, fracture_moment;
    template <class F> static void each(F f) {
        using R = HingeSummary;
        f("rotation_max", &R::rotation_max), f("moment_max", &R::moment_max), f("opening_time", &R::opening_time);
        f("rest_time", &R::rest_time), f("turning", &R::turning), f("energy", &R::energy);
        f("fracture_time", &R::fracture_time), f("fracture_moment", &R::fracture_moment);
    }
};

// zeros in every column
template <class R> void resize(R& record, std::size_t size) {
    R::each([&](const char*, auto column) { (record.*column).assign(size, 0.0); });
}

// one row of a column
template <class T> void put(std::vector<T>& all, std::size_t row, const std::vector<T>& one) {
    std::copy(one.begin(), one.end(), all.begin() + static_cast<std::ptrdiff_t>(row * one.size()));
}

// Row `from` of a column with so many rows, to a row of another column.
template <class T> void put_from(std::vector<T>& all, std::size_t row, const std::vector<T>& own, std::size_t from, std::size_t rows) {
    const std::size_t width = own.size() / rows;
    std::copy_n(own.begin() + static_cast<std::ptrdiff_t>(from * width), width, all.begin() + static_cast<std::ptrdiff_t>(row * width));
}

// the same of every column
template <class R> void put_record(R& all, std::size_t row, const R& own, std::size_t from, std::size_t rows) {
    R::each([&](const char*, auto column) { put_from(all.*column, row, own.*column, from, rows); });
}

// one row of every column
template <class R> void put_row(R& all, std::size_t row, const R& one) {
    R::each([&](const char*, auto column) { put(all.*column, row, one.*column); });
}

}  // namespace crumple

// Length of the next step: what the error of the last one allows, the closing of a contact ahead, and the time that is left.
#pragma once

namespace crumple::spatial {

// A step that is tried.
struct StepPlan {
    double h = 0;           // its length [s]
    double stop = 0;        // time at which a step must end [s]
    bool last = false;      // it ends there
    bool cut = false;       // something other than the error limits it
    bool smallest = false;  // no shorter one can replace it
    double unresolved = 0;  // see `StepBound::Step`
};

class StepLength {
public:
    // smallest and largest length [s]
    StepLength(double least, double most) : least_(least), most_(most) {}

    // what the error allows; 0 before the first step
    double allowed() const { return h_; }
    // before the first step of a stage, and at its beginning
    void begin(double duration);
    void forget() { h_ = refused_error_ = 0; }
    // Length and flags of the next step, of at most `longest`, before limits by loads; `aimed`: it is that of a leader's step.
    double wanted(double longest, double left, bool aimed) const;
    StepPlan plan(double h, double wanted, double longest, double left) const;
    // whether a step of length h can be repeated up to the closing of a contact
    bool can_land(double h) const;
    // Whether a step of length h that closes a contact after a time is to end there; it is then the next one.  Closing times can be much
    // too early, because joined bodies yield less than each alone: after some landings that did not close the contact they are doubled.
    bool land(double h, double closing);
    // at an impact
    void struck() { short_landings_ = 0; }
    // after a step of length h that was rejected for its error e, or ends where a share of it does
    void shorten(double h, double e, bool quasi_static);
    void end_at(double share, double h);
    // after a step with the error e
    void follow(const StepPlan& plan, double e, bool quasi_static);

private:
    double after(double h, double e, bool quasi_static) const;

    double least_, most_;
    double h_ = 0;
    double refused_ = 0, refused_error_ = 0;  // of the step rejected last from the present state; error 0: none was
    int short_landings_ = 0;  // landings in a row that did not lead to an impact
    double landing_ = 0;  // length of the step that ends at the closing of a contact; 0 if none is ahead
};

}  // namespace crumple::spatial

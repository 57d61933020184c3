#include "settings.hpp"

#include <math.h>

namespace yehu {

int parameter_of(uint32_t number) {
    for (int i = 0; i < PARAMETERS; i++)
        if (parameters[i].number == number) return i;
    return -1;
}

double to_unit(int parameter, double value) {
    const Parameter &p = parameters[parameter];
    value = value < p.lo ? p.lo : value > p.hi ? p.hi : value;
    return p.exponential ? log(value / p.lo) / log(p.hi / p.lo) : (value - p.lo) / (p.hi - p.lo);
}

double from_unit(int parameter, double unit) {
    const Parameter &p = parameters[parameter];
    unit = unit > 0.0 ? unit < 1.0 ? unit : 1.0 : 0.0;
    if (p.steps > 0) return p.lo + floor(unit * p.steps + 0.5);
    const double value = p.exponential ? p.lo * pow(p.hi / p.lo, unit) : p.lo + unit * (p.hi - p.lo);
    /* Hosts that keep numbers of 32 bits give the usual value back as it was. */
    return fabs(unit - to_unit(parameter, p.usual)) < 1e-7 ? p.usual : value;
}

bool is_same(int parameter, double one, double other) {
    return one == other || (float)to_unit(parameter, one) == (float)to_unit(parameter, other);
}

Settings::Settings() {
    for (int i = 0; i < PARAMETERS; i++) values[i] = parameters[i].usual;
    for (auto &each : changed) each = 0;
}

double Settings::usual(int parameter) const {
    for (int set = 0; set < SETS; set++) {
        const Values &own = sets[set][chosen(set)];
        for (int i = 0; i < own.count; i++)
            if (own.values[i].parameter == parameter) return own.values[i].value;
    }
    return parameters[parameter].usual;
}

/* The preset or room that most values are of. */
void Settings::find(int set) {
    int best = 0, least = PARAMETERS;
    for (int i = 1; i <= parameters[set].steps; i++) {
        const int off = count_changed(set, i);
        if (off < least) best = i, least = off;
    }
    changed[set] = least > 0 ? best : 0;
    store(set, least > 0 ? 0 : best);
}

int Settings::count_changed(int set, int choice) const {
    int count = 0;
    for (int i = 0; i < sets[set][choice].count; i++) {
        const Value &wanted = sets[set][choice].values[i];
        count += !is_same(wanted.parameter, value(wanted.parameter), wanted.value);
    }
    return count;
}

void Settings::copy(const Settings &other) {
    for (int i = 0; i < PARAMETERS; i++) values[i] = other.value(i);
    for (int set = 0; set < SETS; set++) changed[set] = other.changed[set].load();
}

void Settings::store(int parameter, double value) {
    const Parameter &p = parameters[parameter];
    if (p.steps > 0) value = floor(value + 0.5);
    values[parameter].store(value < p.lo ? p.lo : value > p.hi ? p.hi : value, std::memory_order_relaxed);
}

} /* namespace yehu */

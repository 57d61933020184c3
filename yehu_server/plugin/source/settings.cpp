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
    changed = 0;
}

double Settings::usual(int parameter) const {
    for (int room = 0; room < 2; room++) {
        const Values &own = presets[nearest(room == 1)];
        for (int i = 0; i < own.count; i++)
            if (own.values[i].parameter == parameter) return own.values[i].value;
    }
    return parameters[parameter].usual;
}

int Settings::nearest(bool room) const {
    int best = preset(), least = PARAMETERS;
    if (best != NO_PRESET && is_room[best] == room) return best;
    for (int i = 1; i <= parameters[PRESET].steps; i++) {
        const int off = count_changed(i);
        if (is_room[i] == room && off < least) best = i, least = off;
    }
    return best;
}

int Settings::count_changed(int preset) const {
    int count = 0;
    for (int i = 0; i < presets[preset].count; i++) {
        const Value &wanted = presets[preset].values[i];
        count += !is_same(wanted.parameter, value(wanted.parameter), wanted.value);
    }
    return count;
}

void Settings::copy(const Settings &other) {
    for (int i = 0; i < PARAMETERS; i++) values[i] = other.value(i);
    changed = other.changed.load();
}

void Settings::store(int parameter, double value) {
    const Parameter &p = parameters[parameter];
    if (p.steps > 0) value = floor(value + 0.5);
    values[parameter].store(value < p.lo ? p.lo : value > p.hi ? p.hi : value, std::memory_order_relaxed);
}

} /* namespace yehu */

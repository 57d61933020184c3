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

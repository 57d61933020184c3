// A yardstick for the kernel's speed: a bowed string that one finger stops, as a plain loop.
//
// The scheme of [Yehu] with the corrections of docs/physics.md, by the paper's formulas for contacts
// that share no node: no tension modulation, no hair's texture, one finger, nothing that moves.
// Reads SI values from stdin in the order of `main`, and writes the processor time of the loop (s)
// and the mean number of evaluations of the friction law to stdout; with a file's name as argument
// also the sound (Pa) there, as float64.

#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <iostream>
#include <utility>
#include <vector>

namespace {

constexpr int MODES = 11, SECTIONS = 25, POINTS = 128, BLOCK = 128;
constexpr double TOLERANCE = 2e-13;  // m/s, as in the kernel
constexpr int MAX_ITERATIONS = 100;

struct Contact {  // I, eq. (28): four neighbouring nodes
    int first;
    double weights[4];

    double read(const double* u) const {
        double total = 0.0;
        for (int j = 0; j < 4; ++j) total += weights[j] * u[first + j];
        return total;
    }
    void spread(double* u, double amount) const {
        for (int j = 0; j < 4; ++j) u[first + j] += weights[j] * amount;
    }
    double squared() const {
        double total = 0.0;
        for (double weight : weights) total += weight * weight;
        return total;
    }
};

struct String {
    int N;
    double h, B_0, B_1, B_2, C_0, C_1, spread;
    std::array<double, POINTS> levels[3] = {};  // node l at l + 1, one ghost node at each end
    double *next = levels[0].data(), *now = levels[1].data(), *prev = levels[2].data();

    void prepare(double k, double headroom) {
        double L, rho, r, T, E, sigma_0, sigma_1;
        std::cin >> L >> rho >> r >> T >> E >> sigma_0 >> sigma_1;
        const double rho_A = rho * M_PI * r * r, EI = E * M_PI * std::pow(r, 4) / 4.0;
        const double c_2 = headroom * T / rho_A;
        const double least_h = std::sqrt(  // eq. (57)
            c_2 * k * k / 2.0 + 2.0 * k * sigma_1 +
            k / 2.0 * std::sqrt(std::pow(c_2 * k + 4.0 * sigma_1, 2) + 16.0 * EI / rho_A));
        N = int(L / least_h);
        h = L / N;
        const double A_s = rho_A / (k * k) + rho_A * sigma_0 / k;  // eq. (32)
        const double d2 = (T + 2.0 * rho_A * sigma_1 / k) / (h * h), d4 = EI / std::pow(h, 4);
        const double loss = 2.0 * rho_A * sigma_1 / (k * h * h);
        B_0 = (2.0 * rho_A / (k * k) - 2.0 * d2 - 6.0 * d4) / A_s;
        B_1 = (d2 + 4.0 * d4) / A_s;
        B_2 = -d4 / A_s;
        C_0 = (-rho_A / (k * k) + rho_A * sigma_0 / k + 2.0 * loss) / A_s;
        C_1 = -loss / A_s;
        spread = 1.0 / (h * A_s);
    }

    Contact cubic(double x) const {
        const int l = int(x / h);
        const double a = x / h - l;
        return {l, {-a * (a - 1.0) * (a - 2.0) / 6.0, (a - 1.0) * (a + 1.0) * (a - 2.0) / 2.0,
                    -a * (a + 1.0) * (a - 2.0) / 2.0, a * (a + 1.0) * (a - 1.0) / 6.0}};
    }

    Contact linear(double x) const {
        const int l = int(x / h);
        const double a = x / h - l;
        return {l, {0.0, 1.0 - a, a, 0.0}};
    }

    void advance() {  // u* of eq. (58)
        double* __restrict to = next;
        const double* __restrict u = now;
        const double* __restrict v = prev;
        for (int l = 2; l <= N; ++l)
            to[l] = B_0 * u[l] + B_1 * (u[l - 1] + u[l + 1]) + B_2 * (u[l - 2] + u[l + 2]) +
                    C_0 * v[l] + C_1 * (v[l - 1] + v[l + 1]);
    }

    void turn() {  // simple supports, eq. (3); then the next sample
        next[0] = -next[2];
        next[N + 2] = -next[N];
        std::swap(prev, now);
        std::swap(now, next);
    }
};

struct Bridge {  // eqs. (41)-(45)
    std::array<double, MODES> A, B, C, levels[3] = {};
    double *next = levels[0].data(), *now = levels[1].data(), *prev = levels[2].data();
    double C_sum = 0.0;

    void prepare(double k) {
        for (int m = 0; m < MODES; ++m) {
            double frequency, M, R;
            std::cin >> frequency >> M >> R;
            const double K = M * std::pow(2.0 / k * std::tan(M_PI * frequency * k), 2);
            const double lambda = 4.0 * M + k * k * K + 2.0 * k * R;
            A[m] = (8.0 * M - 2.0 * k * k * K) / lambda;
            B[m] = (-4.0 * M - k * k * K + 2.0 * k * R) / lambda;
            C[m] = 4.0 * k * k / lambda;
            C_sum += C[m];
        }
    }

    double advance() {
        double total = 0.0;
        for (int m = 0; m < MODES; ++m) {
            next[m] = A[m] * now[m] + B[m] * prev[m];
            total += next[m];
        }
        return total;
    }

    void turn(double force) {
        for (int m = 0; m < MODES; ++m) next[m] -= C[m] * force;
        std::swap(prev, now);
        std::swap(now, next);
    }
};

struct Radiation {  // section 4.3
    std::array<double, SECTIONS> b_0, b_1, a_1, a_2, s_1 = {}, s_2 = {};
    double direct;

    void prepare() {
        for (int j = 0; j < SECTIONS; ++j) std::cin >> b_0[j] >> b_1[j] >> a_1[j] >> a_2[j];
        std::cin >> direct;
    }

    double advance(double force) {
        double pressure = direct * force;
        for (int j = 0; j < SECTIONS; ++j) {
            const double y = b_0[j] * force + s_1[j];
            s_1[j] = b_1[j] * force - a_1[j] * y + s_2[j];
            s_2[j] = -a_2[j] * y;
            pressure += y;
        }
        return pressure;
    }
};

struct Friction {  // eqs. (16)-(20), (25), (46)-(49)
    double epsilon_0, epsilon_1, v_s, mu_C, mu_S, xi;
    double k, z = 0.0, f_b = 0.0;
    long evaluations = 0;

    void prepare(double step) {
        k = step;
        std::cin >> epsilon_0 >> epsilon_1 >> v_s >> mu_C >> mu_S >> xi;
    }

    // dz/dt of the law, and its derivatives by v and by the deflection.
    void law(double v, double z_bar, double F_N, double& r, double& by_v, double& by_z) const {
        const double at_1 = F_N / epsilon_0, z_ba = xi * mu_C * at_1;
        r = v;
        by_v = 1.0;
        by_z = 0.0;
        if (v * z_bar <= 0.0 || std::abs(z_bar) <= z_ba) return;
        const double s = std::abs(z_bar);
        const double stribeck = at_1 * (mu_S - mu_C) * std::exp(-(v / v_s) * (v / v_s));
        const double z_ss = at_1 * mu_C + stribeck, dz_ss = -2.0 * v / (v_s * v_s) * stribeck;
        double chi = 1.0, chi_by_s = 0.0, chi_by_ss = 0.0;
        if (s < z_ss) {
            const double width = z_ss - z_ba;
            const double angle = M_PI * (s - 0.5 * (z_ss + z_ba)) / width;
            chi = 0.5 * (1.0 + std::sin(angle));
            chi_by_s = 0.5 * M_PI * std::cos(angle) / width;
            chi_by_ss = -chi_by_s * (s - z_ba) / width;
        }
        const double ratio = s / z_ss;
        r = v * (1.0 - chi * ratio);
        by_v = 1.0 - chi * ratio - v * dz_ss * (chi_by_ss * ratio - chi * ratio / z_ss);
        by_z = -v * (chi_by_s * ratio + chi / z_ss) * std::copysign(1.0, z_bar);
    }

    // Newton's method within a bracket, from the force of the sample before.
    void solve(double free, double mobility, double F_N) {
        const double gamma = mu_C * F_N / epsilon_1;
        const double limit = std::max(1.2 * mu_S * F_N / epsilon_0, std::abs(z));
        const double damping = 2.0 / k * epsilon_1;
        double low = free - mobility * (epsilon_0 * limit + damping * (limit - z));
        double high = free + mobility * (epsilon_0 * limit + damping * (limit + z));
        double v = std::min(std::max(free - mobility * f_b, low), high), z_bar = z;
        for (int n = 0; n < MAX_ITERATIONS; ++n) {
            ++evaluations;
            const double per_root = 1.0 / std::sqrt(v * v + gamma * gamma);
            const double epsilon = mu_C * F_N * per_root, by_v = -epsilon * v * per_root * per_root;
            const double per_stiffness = 1.0 / (epsilon_0 + 2.0 / k * epsilon);
            f_b = (free - v) / mobility;
            z_bar = (f_b + 2.0 / k * epsilon * z) * per_stiffness;
            const double dz_bar = (2.0 / k * by_v * (z - z_bar) - 1.0 / mobility) * per_stiffness;
            double r, r_by_v, r_by_z;
            law(v, z_bar, F_N, r, r_by_v, r_by_z);
            const double residual = r - 2.0 / k * (z_bar - z);
            if (std::abs(residual) <= TOLERANCE * std::max(1.0, std::abs(r))) break;
            (residual > 0.0 ? high : low) = v;
            v -= residual / (r_by_v + (r_by_z - 2.0 / k) * dz_bar);
            if (!(low < v && v < high)) v = 0.5 * (low + high);
        }
        z = 2.0 * z_bar - z;
    }
};

struct Finger {  // eqs. (33)-(40)
    double M_f, K_f, alpha, beta, U_next = 0.0, U, U_prev, Psi[2] = {}, force[2] = {};

    void prepare() {
        std::cin >> M_f >> K_f >> alpha >> beta >> U;
        U_prev = U;
    }

    // Press with a force (N), positive; u_star, u, u_prev: displacements under the finger.
    void advance(double k, double press, const double* u_star, const double* u,
                 const double* u_prev, const double* compliance) {
        const double C_f = k * k / M_f, U_star = 2.0 * U - U_prev - C_f * press;
        double a[2] = {}, b[2] = {}, g[2] = {}, sum_a = 0.0, sum_b = 0.0;
        for (int i = 0; i < 2; ++i) {
            const double eta = u[i] - U, eta_prev = u_prev[i] - U_prev;
            if (eta <= 0.0 || Psi[i] < 0.0) Psi[i] = 0.0;
            if (eta <= 0.0) continue;
            g[i] = std::sqrt(0.5 * K_f * (alpha + 1.0)) * std::pow(eta, 0.5 * (alpha - 1.0));
            const double travel = u_star[i] - U_star - eta_prev;
            if (4.0 * Psi[i] + g[i] * travel < 0.0) g[i] = -4.0 * Psi[i] / travel;  // eq. (34)
            const double A = 0.25 * g[i] * g[i] + beta * g[i] * Psi[i] / (2.0 * k);
            const double pivot = 1.0 / (1.0 + A * compliance[i]);
            a[i] = A * pivot;
            b[i] = (A * (u_star[i] - eta_prev) + g[i] * Psi[i]) * pivot;
            sum_a += a[i];
            sum_b += b[i];
        }
        U_next = (U_star + C_f * sum_b) / (1.0 + C_f * sum_a);
        for (int i = 0; i < 2; ++i) {
            force[i] = b[i] - a[i] * U_next;
            const double eta_next = u_star[i] - compliance[i] * force[i] - U_next;
            Psi[i] += 0.5 * g[i] * (eta_next - (u_prev[i] - U_prev));
        }
        U_prev = U;
        U = U_next;
    }
};

struct Yehu {
    double k, v_b, F_N, press, A_h, B_h, C_h;
    String strings[2];
    Bridge bridge;
    Radiation radiation;
    Friction friction;
    Finger finger;
    Contact at_bridge[2], at_finger[2], at_bow;
    double finger_compliance[2], S[2], mobility;
    double zeta_next[2] = {}, zeta[2] = {}, zeta_prev[2] = {};

    void prepare(double rate) {
        double headroom, x_c, x_b, x_f, M_h, K_h, R_h;
        k = 1.0 / rate;
        std::cin >> F_N >> v_b >> x_b >> x_f >> press >> headroom >> x_c;
        for (String& string : strings) string.prepare(k, headroom);
        friction.prepare(k);
        std::cin >> M_h >> K_h >> R_h;
        const double lambda = 4.0 * M_h + k * k * K_h + 2.0 * k * R_h;  // eq. (60)
        A_h = (8.0 * M_h - 2.0 * k * k * K_h) / lambda;
        B_h = (-4.0 * M_h - k * k * K_h + 2.0 * k * R_h) / lambda;
        C_h = 4.0 * k * k / lambda;
        finger.prepare();
        bridge.prepare(k);
        radiation.prepare();
        for (int i = 0; i < 2; ++i) {
            at_bridge[i] = strings[i].cubic(x_c);
            at_finger[i] = strings[i].cubic(x_f);
            finger_compliance[i] = strings[i].spread * at_finger[i].squared();
            S[i] = bridge.C_sum + strings[i].spread * at_bridge[i].squared();
        }
        at_bow = strings[0].linear(x_b);
        mobility = (strings[0].spread * at_bow.squared() + C_h) / (2.0 * k);
    }

    double step() {
        for (String& string : strings) string.advance();
        const double q_sum = bridge.advance();
        for (int i = 0; i < 2; ++i) zeta_next[i] = A_h * zeta[i] + B_h * zeta_prev[i];

        // Bridge, eq. (45).
        const double gap_1 = q_sum - at_bridge[0].read(strings[0].next);
        const double gap_2 = q_sum - at_bridge[1].read(strings[1].next);
        const double determinant = S[0] * S[1] - bridge.C_sum * bridge.C_sum;
        const double f_1 = (S[1] * gap_1 - bridge.C_sum * gap_2) / determinant;
        const double f_2 = (S[0] * gap_2 - bridge.C_sum * gap_1) / determinant;

        // Bow, eqs. (46)-(49), on the first string.
        const double travel = at_bow.read(strings[0].next) - at_bow.read(strings[0].prev);
        const double hair = zeta_next[0] - zeta_prev[0];
        friction.solve((travel + hair) / (2.0 * k) - v_b, mobility, F_N);

        // Finger, eqs. (33)-(40).
        double u_star[2], u[2], u_prev[2];
        for (int i = 0; i < 2; ++i) {
            u_star[i] = at_finger[i].read(strings[i].next);
            u[i] = at_finger[i].read(strings[i].now);
            u_prev[i] = at_finger[i].read(strings[i].prev);
        }
        finger.advance(k, press, u_star, u, u_prev, finger_compliance);

        // All forces move what they act on, eqs. (30), (59), (60).
        const double f_c[2] = {f_1, f_2};
        zeta_next[0] -= C_h * friction.f_b;
        at_bow.spread(strings[0].next, -strings[0].spread * friction.f_b);
        for (int i = 0; i < 2; ++i) {
            at_bridge[i].spread(strings[i].next, strings[i].spread * f_c[i]);
            at_finger[i].spread(strings[i].next, -strings[i].spread * finger.force[i]);
            strings[i].turn();
            zeta_prev[i] = zeta[i];
            zeta[i] = zeta_next[i];
        }
        bridge.turn(f_1 + f_2);
        return radiation.advance(f_1 + f_2);
    }
};

}  // namespace

int main(int count, char** words) {
    double rate, seconds, settled;
    std::cin >> rate >> seconds >> settled;  // the first `settled` seconds are not timed
    Yehu yehu;
    yehu.prepare(rate);
    if (!std::cin) return 2;
    std::FILE* file = count > 1 ? std::fopen(words[1], "wb") : nullptr;

    const long frames = std::lround(rate * seconds), first = std::lround(rate * settled);
    std::array<double, BLOCK> block;
    std::clock_t start = std::clock();
    bool is_timed = first == 0;
    for (long n = 0; n < frames; n += BLOCK) {
        if (!is_timed && n >= first) {
            start = std::clock();
            is_timed = true;
        }
        for (double& sample : block) sample = yehu.step();
        if (file) std::fwrite(block.data(), sizeof(double), block.size(), file);
    }
    const double spent = double(std::clock() - start) / CLOCKS_PER_SEC;
    if (file) std::fclose(file);
    std::printf("%.9g %.9g %.9g\n", spent, double(yehu.friction.evaluations) / frames, block[0]);
}

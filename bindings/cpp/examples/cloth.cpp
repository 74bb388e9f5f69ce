// A cloth hung by two corners, falling: cloth folder [frames]
//
// Dynamics with the wrapper: one call of solve is one time step. Writes frame_000.obj, frame_001.obj, ... into the
// folder. From half-way on, one corner is carried to another place: constraints may be edited between any two steps.
#include <shapeop.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

constexpr int side = 30;                     // points along each side
constexpr double spacing = 1.0 / (side - 1); // metres: the cloth is 1 m wide, and gravity is in metres per second²
constexpr double mass = 0.5 / (side * side); // of each point: the cloth weighs half a kilogram

int at(int column, int row) {
    return row * side + column;
}

// Threads may stretch by 5 % and shrink by 10 %, as cloth gives way to compression; lengths are in model units.
void add_threads(shapeop::Solver &solver) {
    std::vector<int> edges;
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            if (column + 1 < side) {
                edges.insert(edges.end(), {at(column, row), at(column + 1, row)});
            }
            if (row + 1 < side) {
                edges.insert(edges.end(), {at(column, row), at(column, row + 1)});
            }
        }
    }
    // Two indices each, one weight for all, one set of scalars (length, least and greatest stretch) for all.
    solver.add_constraints("EdgeStrain", edges, {2}, {1000.0}, shapeop::Scalars::same({spacing, 0.9, 1.05}));
}

void write_frame(const std::string &folder, int frame, const std::vector<double> &points) {
    char name[32];
    std::snprintf(name, sizeof name, "/frame_%03d.obj", frame);
    std::ofstream file(folder + name);
    for (std::size_t i = 0; i < points.size(); i += 3) {
        file << "v " << points[i] << ' ' << points[i + 1] << ' ' << points[i + 2] << '\n';
    }
    for (int row = 0; row + 1 < side; ++row) {
        for (int column = 0; column + 1 < side; ++column) {
            file << "f " << at(column, row) + 1 << ' ' << at(column + 1, row) + 1 << ' ' << at(column + 1, row + 1) + 1
                 << ' ' << at(column, row + 1) + 1 << '\n';
        }
    }
    if (!file.flush()) {
        throw std::runtime_error(folder + name + " cannot be written");
    }
}

void simulate(const std::string &folder, int frames) {
    shapeop::Solver solver;
    std::vector<double> points;
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            points.insert(points.end(), {column * spacing, row * spacing, 0.0});
        }
    }
    solver.set_points(points);
    add_threads(solver);
    // A point is held by the place where it is when the constraint is added, until that is edited.
    const double heavy = 1e5;
    solver.add_constraint("Closeness", {at(0, 0)}, heavy);
    const int corner = solver.add_constraint("Closeness", {at(side - 1, 0)}, heavy);
    solver.add_gravity_force({0, 0, -9.81});
    solver.init_dynamic(mass, 0.99, 1.0 / 60);

    for (int frame = 0; frame < frames; ++frame) {
        const double carried = std::clamp((frame - frames / 2) / 30.0, 0.0, 1.0); // over half a second
        solver.edit_constraint("Closeness", corner, {1 - 0.4 * carried, 0.2 * carried, 0.3 * carried});
        solver.solve(10);           // one sixtieth of a second, in ten iterations
        solver.copy_points(points); // into the same memory each time
        write_frame(folder, frame, points);
    }
    double lowest = 0;
    for (std::size_t i = 2; i < points.size(); i += 3) {
        lowest = std::min(lowest, points[i]);
    }
    std::cout << frames << " frames; the lowest point hangs at " << lowest << '\n';
}

} // namespace

int main(int argc, char **argv) {
    if (argc != 2 && argc != 3) {
        std::cerr << "usage: cloth folder [frames]\n";
        return EXIT_FAILURE;
    }
    try {
        simulate(argv[1], argc == 3 ? std::stoi(argv[2]) : 120);
    } catch (const std::exception &error) {
        std::cerr << error.what() << '\n';
        return EXIT_FAILURE;
    }
    return EXIT_SUCCESS;
}

// Solves the three problems of tests/languages/README.md with the C++ wrapper: three_problems mesh.obj folder
#include <shapeop.hpp>

#include <cstdlib>
#include <exception>
#include <fstream>
#include <iostream>
#include <limits>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

void write(const shapeop::Solver &solver, const std::string &path) {
    std::ofstream file(path);
    file.precision(std::numeric_limits<double>::max_digits10);
    const std::vector<double> points = solver.points();
    for (std::size_t i = 0; i < points.size(); i += 3) {
        file << points[i] << ' ' << points[i + 1] << ' ' << points[i + 2] << '\n';
    }
    if (!file.flush()) {
        throw std::runtime_error(path + " cannot be written");
    }
}

void quad(const std::string &folder) {
    shapeop::Solver solver;
    solver.set_points({0, 0, 0.3, 1.2, 0, 0, 1, 1, 0.4, 0, 1.1, -0.1});
    solver.add_constraint("Plane", {0, 1, 2, 3}, 1);
    solver.add_constraint("Rigid", {0, 1, 2, 3}, 2, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
    solver.add_constraint("Closeness", {0}, 0.5, {0, 0, 0.2});
    solver.init();
    solver.solve(25);
    write(solver, folder + "/quad.txt");
}

void planarise(const std::string &mesh, const std::string &folder) {
    std::ifstream file(mesh);
    if (!file) {
        throw std::runtime_error(mesh + " cannot be read");
    }
    std::vector<double> points;
    std::vector<int> quads;
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line.substr(line.empty() ? 0 : 1));
        double x, y, z;
        int corners[4];
        if (line.rfind("v ", 0) == 0 && words >> x >> y >> z) {
            points.insert(points.end(), {x, y, z});
        } else if (line.rfind("f ", 0) == 0) {
            for (int &corner : corners) {
                words >> corner;
                quads.push_back(corner - 1);
            }
            if (!words) {
                throw std::runtime_error(mesh + ": a face is no quad: " + line);
            }
        }
    }
    std::vector<int> each(points.size() / 3);
    std::iota(each.begin(), each.end(), 0);

    shapeop::Solver solver;
    solver.set_points(points);
    solver.add_constraints("Plane", quads, {4});
    solver.add_constraints("Closeness", each, {1}, {0.05});
    solver.init();
    solver.solve(100);
    write(solver, folder + "/planarise.txt");
}

void cloth(const std::string &folder) {
    constexpr int side = 20;
    std::vector<double> points;
    std::vector<int> edges;
    for (int j = 0; j < side; ++j) {
        for (int i = 0; i < side; ++i) {
            const int here = side * j + i;
            points.insert(points.end(), {double(i), double(j), 0.0});
            if (i + 1 < side) {
                edges.insert(edges.end(), {here, here + 1});
            }
            if (j + 1 < side) {
                edges.insert(edges.end(), {here, here + side});
            }
        }
    }
    shapeop::Solver solver;
    solver.set_points(points);
    solver.add_constraints("EdgeStrain", edges, {2}, {10.0}, shapeop::Scalars::same({1, 0.9, 1.1}));
    const int held = solver.add_constraints("Closeness", {0, 19, 399}, {1}, {1000.0}).back();
    solver.add_gravity_force({0, 0, -1});
    const int force = solver.add_vertex_force({0.5, 0, 2}, 380);
    solver.init_dynamic(1, 0.95, 0.1);
    for (int step = 1; step <= 60; ++step) {
        if (step == 11) {
            solver.edit_constraint("Closeness", held, {14, 14, 5});
        }
        if (step == 31) {
            solver.edit_vertex_force(force, {0, 0.5, -1}, 380);
        }
        solver.solve(5);
    }
    write(solver, folder + "/cloth.txt");
}

} // namespace

int main(int argc, char **argv) {
    try {
        if (argc != 3) {
            throw std::runtime_error("usage: three_problems mesh.obj folder");
        }
        quad(argv[2]);
        planarise(argv[1], argv[2]);
        cloth(argv[2]);
    } catch (const std::exception &error) {
        std::cerr << error.what() << '\n';
        return EXIT_FAILURE;
    }
    return EXIT_SUCCESS;
}

// Planarises the faces of a mesh: planarise in.obj out.obj
//
// With the library's recipe, which makes the constraints from the mesh, and its measure of planarity. planarise.c adds
// the constraints one kind after the other.
#include <shapeop.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iostream>
#include <iterator>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

// Faces are point indices behind each other; counts says how many belong to each. This is how the library takes them.
struct Mesh {
    std::vector<double> points;
    std::vector<int> corners, counts;
};

// Reads the lines "v x y z" and "f i j k ..." (or "f i/t/n ..."), which count points from 1.
Mesh read_obj(const std::string &path) {
    std::ifstream file(path);
    if (!file) {
        throw std::runtime_error(path + " cannot be read");
    }
    Mesh mesh;
    for (std::string line, kind, word; std::getline(file, line);) {
        std::istringstream words(line);
        words >> kind;
        if (kind == "v") {
            double x, y, z;
            words >> x >> y >> z;
            mesh.points.insert(mesh.points.end(), {x, y, z});
        } else if (kind == "f") {
            mesh.counts.push_back(0);
            for (; words >> word; ++mesh.counts.back()) {
                mesh.corners.push_back(std::stoi(word) - 1);
            }
        }
        kind.clear();
    }
    return mesh;
}

void write_obj(const std::string &path, const Mesh &mesh) {
    std::ofstream file(path);
    file.precision(std::numeric_limits<double>::max_digits10);
    for (std::size_t i = 0; i < mesh.points.size(); i += 3) {
        file << "v " << mesh.points[i] << ' ' << mesh.points[i + 1] << ' ' << mesh.points[i + 2] << '\n';
    }
    auto corner = mesh.corners.begin();
    for (int count : mesh.counts) {
        file << 'f';
        for (; count > 0; --count) {
            file << ' ' << *corner++ + 1;
        }
        file << '\n';
    }
    if (!file.flush()) {
        throw std::runtime_error(path + " cannot be written");
    }
}

// The distance between the diagonals of a quad over their mean length; 0.01 is one percent.
double worst_planarity(const Mesh &mesh) {
    const std::vector<double> planarity = shapeop::measure_faces("planarity", mesh.points, mesh.corners, mesh.counts);
    return planarity.empty() ? 0 : *std::max_element(planarity.begin(), planarity.end());
}

void planarise(const std::string &from, const std::string &to) {
    Mesh mesh = read_obj(from);
    const double before = worst_planarity(mesh);

    shapeop::RecipeOptions recipe;
    recipe.closeness = 0.001; // the faces weigh 1
    shapeop::Solver solver;
    shapeop::SolveOptions options =
        solver.set_problem(shapeop::recipe("planarize", mesh.points, mesh.corners, mesh.counts, recipe));
    options.max_iterations = 500;

    const shapeop::Report report = solver.solve_until(options, [](const shapeop::Progress &now) {
        if (now.iteration % 50 == 0) {
            std::cout << "iteration " << now.iteration << ": energy " << now.energy << '\n';
        }
        return true; // false would end the solve
    });

    solver.copy_points(mesh.points);
    std::cout << (report.outcome == SO_OUTCOME_CONVERGED ? "converged" : "stopped") << " after " << report.iterations
              << " iterations; the worst face is " << 100 * worst_planarity(mesh) << " % out of plane, was "
              << 100 * before << " %\n";
    write_obj(to, mesh);
}

} // namespace

int main(int argc, char **argv) {
    if (argc != 3) {
        std::cerr << "usage: planarise in.obj out.obj\n";
        return EXIT_FAILURE;
    }
    try {
        planarise(argv[1], argv[2]);
    } catch (const std::exception &error) { // shapeop::Error is one: its text says which argument was wrong, and how
        std::cerr << error.what() << '\n';
        return EXIT_FAILURE;
    }
    return EXIT_SUCCESS;
}

// Decompositions of 3×3 matrices, twins of linalg/small.rs.

//! What is measured of a mesh for tables, reports and pictures.

use anyhow::Result;
use serde::Serialize;
use shapeop::mesh::measure::{self, Spread};
use shapeop::mesh::{Mesh, Topology};

/// The measures of a mesh. Places (`min_at`, `max_at`) are faces, for edges the place in `Topology::edges`, for angles the
/// corner counted through all faces. Ratios are plain numbers: 0.01 is 1 %.
#[derive(Clone, Debug, Serialize)]
pub struct Quality {
    /// Quads: distance of the diagonals over their mean length. Other faces: distance of the farthest corner from the
    /// best-fit plane over the face's mean edge.
    pub planarity: Spread,
    /// Distance of the farthest corner from the face's best-fit plane, in model units.
    pub plane_distance: Spread,
    /// Distance of the farthest corner from the face's best-fit circle over the face's mean edge.
    pub circularity: Spread,
    /// Distance of the farthest corner from the best-fit regular polygon over the face's mean edge.
    pub regularity: Spread,
    /// Lengths of the edges, each once, in model units.
    pub edge_length: Spread,
    /// Angles at the corners of the faces, in degrees.
    pub corner_angle_deg: Spread,
    /// Faces whose planarity is above the limit.
    pub faces_over_limit: usize,
    /// Each face's planarity, for pictures and lists; not part of the report.
    #[serde(skip)]
    pub planarity_of_faces: Vec<f64>,
    #[serde(skip)]
    pub has_only_triangles: bool,
}

impl Quality {
    /// `limit` is the planarity that is still good enough, as a ratio.
    pub fn of(mesh: &Mesh, limit: f64) -> Result<Self> {
        let spread = |measure: fn(&[glam::DVec3]) -> f64| -> Result<Spread> {
            Ok(Spread::of(&measure::of_faces(mesh, measure)?))
        };
        let planarity_of_faces = measure::of_faces(mesh, measure::planarity)?;
        let angles = mesh.faces.iter().flat_map(|face| measure::corner_angles_rad(&mesh.corners(face)));
        let angles_deg: Vec<f64> = angles.map(f64::to_degrees).collect();
        Ok(Self {
            planarity: Spread::of(&planarity_of_faces),
            plane_distance: spread(measure::plane_distance)?,
            circularity: spread(measure::circularity)?,
            regularity: spread(measure::regularity)?,
            edge_length: Spread::of(&measure::edge_lengths(mesh)?),
            corner_angle_deg: Spread::of(&angles_deg),
            faces_over_limit: planarity_of_faces.iter().filter(|planarity| **planarity > limit).count(),
            planarity_of_faces,
            has_only_triangles: mesh.faces.iter().all(|face| face.len() == 3),
        })
    }

    /// The faces from the least planar on, at most `count`.
    pub fn worst_faces(&self, count: usize) -> Vec<usize> {
        let mut faces: Vec<usize> = (0..self.planarity_of_faces.len()).collect();
        faces.sort_by(|&a, &b| self.planarity_of_faces[b].total_cmp(&self.planarity_of_faces[a]));
        faces.truncate(count);
        faces
    }
}

/// What is worth knowing of a mesh's connections before anything is asked of it.
#[derive(Clone, Debug, Serialize)]
pub struct Connections {
    pub points: usize,
    pub faces: usize,
    pub edges: usize,
    /// Number of faces by their number of corners.
    pub faces_by_corners: std::collections::BTreeMap<usize, usize>,
    /// Closed or open chains of boundary edges.
    pub boundaries: usize,
    /// Edges with more than two faces.
    pub non_manifold_edges: Vec<[u32; 2]>,
    /// Edges whose two faces run along it the same way.
    pub misoriented_edges: Vec<[u32; 2]>,
    /// Points that no face has.
    pub unused_points: usize,
}

impl Connections {
    pub fn of(mesh: &Mesh) -> Result<Self> {
        let topology = Topology::new(mesh)?;
        let mut faces_by_corners = std::collections::BTreeMap::new();
        let mut is_used = vec![false; mesh.points.len()];
        for face in &mesh.faces {
            *faces_by_corners.entry(face.len()).or_insert(0) += 1;
            face.iter().for_each(|&point| is_used[point as usize] = true);
        }
        Ok(Self {
            points: mesh.points.len(),
            faces: mesh.faces.len(),
            edges: topology.edges().len(),
            faces_by_corners,
            boundaries: topology.boundary().len(),
            non_manifold_edges: topology.non_manifold_edges(),
            misoriented_edges: topology.misoriented_edges(),
            unused_points: is_used.iter().filter(|is_used| !**is_used).count(),
        })
    }

    /// "1080 quads", "12 triangles, 3 quads, 1 heptagon of 7 corners".
    pub fn faces_in_words(&self) -> String {
        let name = |corners: usize| match corners {
            3 => "triangles".to_owned(),
            4 => "quads".to_owned(),
            5 => "pentagons".to_owned(),
            6 => "hexagons".to_owned(),
            corners => format!("faces of {corners} corners"),
        };
        let parts: Vec<String> =
            self.faces_by_corners.iter().map(|(&corners, count)| format!("{count} {}", name(corners))).collect();
        if parts.is_empty() { "no faces".to_owned() } else { parts.join(", ") }
    }
}

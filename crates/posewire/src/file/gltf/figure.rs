//! The mesh: a bone, broad near its beginning and pointed at its end, from each segment to each of its children.

use super::buffer::{Buffer, Purpose};
use super::rest::Rest;
use posewire_motion::{DVec3, Segment, Skeleton};
use serde_json::{Value, json};

/// The mesh of the figure at rest, in the world.
pub(super) fn mesh(skeleton: &Skeleton, rest: &Rest, buffer: &mut Buffer) -> Value {
    let mut mesh = Mesh::default();
    for (place, segment) in skeleton.segments.iter().enumerate() {
        let origin = rest.origin(place);
        let ends: Vec<_> = rest
            .children(Some(place))
            .into_iter()
            .map(|child| rest.origin(child))
            .collect();
        let far: Vec<_> = ends.iter().filter(|end| end.distance(origin) > SHORTEST).collect();
        if far.is_empty() {
            mesh.add_bone(place, origin, origin + tip(segment, rest));
        }
        for end in far {
            mesh.add_bone(place, origin, *end);
        }
    }
    mesh.primitive(buffer)
}

/// From the world at rest to the axes of each segment, which are not turned then.
pub(super) fn inverse_bind_matrices(rest: &Rest, segments: usize, buffer: &mut Buffer) -> usize {
    let matrices: Vec<_> = (0..segments)
        .map(|place| {
            let [x, y, z] = (-rest.origin(place)).as_vec3().to_array();
            [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, x, y, z, 1.0]
        })
        .collect();
    buffer.floats(&matrices, Purpose::Data)
}

/// Where a segment ends that has no child: at its farthest point.
fn tip(segment: &Segment, rest: &Rest) -> DVec3 {
    let points = segment
        .points
        .iter()
        .map(|point| rest.space.position_from_canonical(point.offset));
    let far = points.filter(|point| point.is_finite() && point.length() > SHORTEST);
    let farthest = far.max_by(|a, b| a.length().total_cmp(&b.length()));
    farthest.unwrap_or(DVec3::Y * STUB)
}

#[derive(Default)]
struct Mesh {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    joints: Vec<[u16; 4]>,
}

impl Mesh {
    /// Eight triangles: four from the beginning to a square near it, four from there to the end.
    fn add_bone(&mut self, segment: usize, from: DVec3, to: DVec3) {
        let way = to - from;
        let (right, up) = way.normalize_or(DVec3::Y).any_orthonormal_pair();
        let radius = (way.length() * BREADTH).clamp(THINNEST, THICKEST);
        let middle = from + way * 0.2;
        let ring = [right, up, -right, -up].map(|side| middle + side * radius);
        for corner in 0..4 {
            let (this, next) = (ring[corner], ring[(corner + 1) % 4]);
            self.add_triangle(segment, [from, next, this]);
            self.add_triangle(segment, [to, this, next]);
        }
    }

    /// A triangle whose corners go round against the clock as seen from outside.
    fn add_triangle(&mut self, segment: usize, corners: [DVec3; 3]) {
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a).normalize_or(DVec3::Y);
        for corner in corners {
            self.positions.push(corner.as_vec3().to_array());
            self.normals.push(normal.as_vec3().to_array());
            self.joints.push([segment as u16, 0, 0, 0]);
        }
    }

    fn primitive(&self, buffer: &mut Buffer) -> Value {
        let weights = vec![[1.0, 0.0, 0.0, 0.0]; self.positions.len()];
        let indices: Vec<_> = (0..self.positions.len() as u32).collect();
        json!({"name": "Figure", "primitives": [{
            "attributes": {
                "POSITION": buffer.bounded(&self.positions, Purpose::Vertices),
                "NORMAL": buffer.floats(&self.normals, Purpose::Vertices),
                "JOINTS_0": buffer.joints(&self.joints),
                "WEIGHTS_0": buffer.floats(&weights, Purpose::Vertices),
            },
            "indices": buffer.indices(&indices),
            "material": 0,
        }]})
    }
}

/// Metres below which two ends are one.
const SHORTEST: f64 = 0.005;
/// Metres of a segment that ends nowhere.
const STUB: f64 = 0.03;
/// How broad a bone is for its length, and at least and at most, m.
const BREADTH: f64 = 0.12;
const THINNEST: f64 = 0.004;
const THICKEST: f64 = 0.035;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sides_of_a_bone_look_outward() {
        let mut mesh = Mesh::default();
        let (from, to) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(1.0, 1.5, 3.2));
        mesh.add_bone(7, from, to);
        assert_eq!(mesh.positions.len(), 24);
        let inside = from + (to - from) * 0.25;
        for (position, normal) in mesh.positions.iter().zip(&mesh.normals) {
            let to_vector = |array: &[f32; 3]| DVec3::from_array(array.map(f64::from));
            assert!((to_vector(position) - inside).dot(to_vector(normal)) > 0.0);
        }
        assert!(mesh.joints.iter().all(|joints| joints[0] == 7));
    }
}

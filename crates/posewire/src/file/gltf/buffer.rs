//! The numbers of a glTF file, and where each array of them lies.

use serde_json::{Value, json};

/// One buffer with a view and an accessor for each array in it.
pub(super) struct Buffer {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

/// What an array is for.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Purpose {
    /// Keyframes and matrices, which the graphics card does not read.
    Data,
    /// A property of each vertex.
    Vertices,
}

impl Buffer {
    /// Without arrays.
    pub(super) fn new() -> Self {
        Self {
            bytes: Vec::new(),
            views: Vec::new(),
            accessors: Vec::new(),
        }
    }

    /// Adds numbers, or vectors or matrices of `N` numbers; gives the number of the accessor.
    pub(super) fn floats<const N: usize>(&mut self, values: &[[f32; N]], purpose: Purpose) -> usize {
        let bytes = values.as_flattened().iter().flat_map(|value| value.to_le_bytes());
        let begin = self.bytes.len();
        self.bytes.extend(bytes);
        self.accessor(
            begin,
            values.len(),
            FLOAT,
            shape(N),
            (purpose == Purpose::Vertices).then_some(ARRAY_BUFFER),
        )
    }

    /// Adds what [`floats`](Self::floats) does, with the least and the greatest of each component, which glTF demands of
    /// positions of vertices and of times.
    pub(super) fn bounded<const N: usize>(&mut self, values: &[[f32; N]], purpose: Purpose) -> usize {
        let accessor = self.floats(values, purpose);
        let bound = |better: fn(f32, f32) -> f32, start: f32| {
            values.iter().fold([start; N], |mut bound, value| {
                bound
                    .iter_mut()
                    .zip(value)
                    .for_each(|(bound, value)| *bound = better(*bound, *value));
                bound
            })
        };
        self.accessors[accessor]["min"] = json!(bound(f32::min, f32::INFINITY).as_slice());
        self.accessors[accessor]["max"] = json!(bound(f32::max, f32::NEG_INFINITY).as_slice());
        accessor
    }

    /// Adds the four bones that each vertex hangs on.
    pub(super) fn joints(&mut self, values: &[[u16; 4]]) -> usize {
        let begin = self.bytes.len();
        let bytes = values.as_flattened().iter().flat_map(|value| value.to_le_bytes());
        self.bytes.extend(bytes);
        self.accessor(begin, values.len(), UNSIGNED_SHORT, "VEC4", Some(ARRAY_BUFFER))
    }

    /// Adds the vertices of triangles.
    pub(super) fn indices(&mut self, values: &[u32]) -> usize {
        let begin = self.bytes.len();
        self.bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        self.accessor(begin, values.len(), UNSIGNED_INT, "SCALAR", Some(ELEMENT_ARRAY_BUFFER))
    }

    /// The bytes, the views and the accessors.
    pub(super) fn finish(self) -> (Vec<u8>, Value, Value) {
        (self.bytes, Value::Array(self.views), Value::Array(self.accessors))
    }

    /// All arrays are whole words, so that each begins where a word does.
    fn accessor(&mut self, begin: usize, count: usize, component: u32, shape: &str, target: Option<u32>) -> usize {
        let mut view = json!({"buffer": 0, "byteOffset": begin, "byteLength": self.bytes.len() - begin});
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        let number = self.accessors.len();
        self.views.push(view);
        self.accessors
            .push(json!({"bufferView": number, "componentType": component, "count": count, "type": shape}));
        number
    }
}

const fn shape(components: usize) -> &'static str {
    match components {
        1 => "SCALAR",
        3 => "VEC3",
        4 => "VEC4",
        _ => "MAT4",
    }
}

const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const FLOAT: u32 = 5126;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrays_lie_one_after_the_other_with_their_bounds() {
        let mut buffer = Buffer::new();
        buffer.joints(&[[0, 1, 2, 3]]);
        buffer.bounded(&[[1.0, 5.0, -2.0], [0.5, 6.0, -3.0]], Purpose::Vertices);
        let (bytes, views, accessors) = buffer.finish();
        assert_eq!(bytes.len(), 8 + 24);
        assert_eq!(
            views[1],
            json!({"buffer": 0, "byteOffset": 8, "byteLength": 24, "target": 34962})
        );
        assert_eq!(accessors[1]["type"], "VEC3");
        assert_eq!(accessors[1]["min"], json!([0.5, 5.0, -3.0]));
        assert_eq!(accessors[1]["max"], json!([1.0, 6.0, -2.0]));
    }
}

//! The largest of a value over samples.

/// The largest of a value over the samples seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Largest {
    /// The value.
    pub value: f64,
    /// The first sample that has it.
    pub sample: u32,
}

impl Largest {
    /// The larger of what was known and a new value; of two that are as large, the one known.
    pub(super) fn update(known: &mut Option<Self>, value: f64, sample: u32) {
        if known.is_none_or(|known| value > known.value) {
            *known = Some(Self { value, sample });
        }
    }

    /// The place and the value of the largest of all.
    pub fn of_all(entries: &[Option<Self>]) -> Option<(usize, Self)> {
        let known = entries.iter().enumerate();
        known
            .filter_map(|(place, largest)| Some((place, (*largest)?)))
            .reduce(|a, b| if b.1.value > a.1.value { b } else { a })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_of_the_largest_counts() {
        let mut largest = None;
        for (value, sample) in [(1.0, 3), (2.0, 4), (2.0, 5), (0.5, 6)] {
            Largest::update(&mut largest, value, sample);
        }
        assert_eq!(largest, Some(Largest { value: 2.0, sample: 4 }));
        assert_eq!(Largest::of_all(&[None, largest, largest]), Some((1, largest.unwrap())));
        assert_eq!(Largest::of_all(&[None]), None);
    }
}

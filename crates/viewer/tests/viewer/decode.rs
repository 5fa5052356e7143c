//! Reads the binary messages as a page does.

/// A tick.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Tick {
    pub(crate) number: u32,
    pub(crate) clock_s: f64,
    pub(crate) records: Vec<Record>,
}

/// A subject's record. NaN is what was not tracked or not sent.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Record {
    pub(crate) id: u32,
    pub(crate) sample: u32,
    pub(crate) contacts: u32,
    pub(crate) time_s: f64,
    pub(crate) age_s: f32,
    pub(crate) timecode_ms: Option<u32>,
    pub(crate) state: u8,
    pub(crate) flags: u8,
    pub(crate) position: Vec<[f32; 3]>,
    pub(crate) orientation: Vec<[f32; 4]>,
    pub(crate) center: [f32; 3],
    pub(crate) markers: Vec<[f32; 3]>,
}

/// A series.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Series {
    pub(crate) id: u16,
    pub(crate) times_s: Vec<f64>,
    pub(crate) values: Vec<f32>,
}

impl Series {
    pub(crate) fn samples(self) -> impl Iterator<Item = (f64, f32)> {
        self.times_s.into_iter().zip(self.values)
    }
}

pub(crate) fn tick(bytes: &[u8]) -> Option<Tick> {
    let mut input = Input(bytes);
    let [1, 1] = input.take()? else { return None };
    let count = u16::from_le_bytes(input.take()?);
    let number = u32::from_le_bytes(input.take()?);
    let clock_s = f64::from_le_bytes(input.take()?);
    let records: Vec<_> = records(input.0)?;
    (records.len() == usize::from(count)).then_some(Tick {
        number,
        clock_s,
        records,
    })
}

/// Records to the end of the bytes.
pub(crate) fn records(bytes: &[u8]) -> Option<Vec<Record>> {
    let mut input = Input(bytes);
    let mut records = Vec::new();
    while !input.0.is_empty() {
        let length = u32::from_le_bytes(*input.0.first_chunk()?) as usize;
        let (one, rest) = input.0.split_at_checked(length)?;
        records.push(record(one)?);
        input.0 = rest;
    }
    Some(records)
}

pub(crate) fn series(bytes: &[u8]) -> Option<Series> {
    let mut input = Input(bytes);
    let [2, 1] = input.take()? else { return None };
    let id = u16::from_le_bytes(input.take()?);
    let count = u32::from_le_bytes(input.take()?) as usize;
    if input.0.len() != count.checked_mul(12)? {
        return None;
    }
    let times = (0..count)
        .map(|_| input.take().map(f64::from_le_bytes))
        .collect::<Option<_>>()?;
    let values = (0..count)
        .map(|_| input.take().map(f32::from_le_bytes))
        .collect::<Option<_>>()?;
    Some(Series {
        id,
        times_s: times,
        values,
    })
}

fn record(bytes: &[u8]) -> Option<Record> {
    let mut input = Input(bytes);
    let _length: [u8; 4] = input.take()?;
    let id = u32::from_le_bytes(input.take()?);
    let sample = u32::from_le_bytes(input.take()?);
    let contacts = u32::from_le_bytes(input.take()?);
    let time_s = f64::from_le_bytes(input.take()?);
    let age_s = f32::from_le_bytes(input.take()?);
    let timecode_ms = Some(u32::from_le_bytes(input.take()?)).filter(|&code| code != u32::MAX);
    let [state, flags] = input.take()?;
    let segments = usize::from(u16::from_le_bytes(input.take()?));
    let markers = usize::from(u16::from_le_bytes(input.take()?));
    let [0, 0] = input.take()? else { return None };
    if input.0.len() != 4 * (7 * segments + 3 + 3 * markers) {
        return None;
    }
    Some(Record {
        id,
        sample,
        contacts,
        time_s,
        age_s,
        timecode_ms,
        state,
        flags,
        position: input.lists(segments)?,
        orientation: input.lists(segments)?,
        center: input.floats()?,
        markers: input.lists(markers)?,
    })
}

struct Input<'a>(&'a [u8]);

impl Input<'_> {
    fn take<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (head, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(*head)
    }

    fn floats<const N: usize>(&mut self) -> Option<[f32; N]> {
        let mut floats = [0.0; N];
        for float in &mut floats {
            *float = f32::from_le_bytes(self.take()?);
        }
        Some(floats)
    }

    fn lists<const N: usize>(&mut self, count: usize) -> Option<Vec<[f32; N]>> {
        (0..count).map(|_| self.floats()).collect()
    }
}

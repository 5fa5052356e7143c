//! Bytes that are not what they were.

use super::FaultKind;
use super::draw::Draw;
use posewire_mxtp::{Datagram, Value, explain};

/// Cuts a datagram short, and as short as it takes for no reader to find it whole. False when it is too short for that.
pub(super) fn truncate(bytes: &mut Vec<u8>, draw: Draw) -> bool {
    let Some(longest) = bytes.len().checked_sub(1).filter(|longest| *longest > 0) else {
        return false;
    };
    let length = 1 + draw.below(FaultKind::Truncate, longest as u64) as usize;
    let cut = (1..=length).rfind(|length| Datagram::decode(&bytes[..*length]).is_err());
    bytes.truncate(cut.unwrap_or(1));
    true
}

/// Flips one bit.
pub(super) fn flip(bytes: &mut [u8], draw: Draw) -> bool {
    let bit = draw.below(FaultKind::Flip, 8 * bytes.len() as u64) as usize;
    let byte = bytes.get_mut(bit / 8);
    byte.map(|byte| *byte ^= 1 << (bit % 8)).is_some()
}

/// Makes a float of an MXTP datagram not a number. False when it has none.
pub(super) fn put_nan(bytes: &mut [u8], draw: Draw) -> bool {
    let explanation = explain(bytes);
    let fields = explanation.fields.iter();
    let floats: Vec<_> = fields.filter(|field| matches!(field.value, Value::Float(_))).collect();
    let place = draw.below(FaultKind::Nan, floats.len() as u64) as usize;
    let Some(float) = floats.get(place) else { return false };
    bytes[float.offset..][..float.length].copy_from_slice(&f32::NAN.to_be_bytes());
    true
}

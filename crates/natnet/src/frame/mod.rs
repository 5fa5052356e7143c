//! Frames of motion capture data (message 7, FRAMEOFDATA).

mod analog;
mod decode;
mod display;
mod encode;
mod marker;
mod rigid_body;
mod skeleton;
mod time;

pub use analog::{AnalogDevice, Channel};
pub use marker::{LabeledMarker, MarkerParams, MarkerSet};
pub use rigid_body::{BodyMarker, BodyParams, RigidBody};
pub use skeleton::{Asset, Skeleton};
pub use time::{FrameParams, HostStamps, PrecisionTime, Timecode};

/// One frame: everything that a server knows about one instant.
///
/// Positions are in metres and orientations are quaternions x, y, z, w, in a right-handed space whose
/// up axis (Y by default), origin and skeleton coordinates (global or local to the parent bone) are
/// settings of the server that no packet states.
///
/// What a version does not carry is `None` or empty. [`encode`](Self::encode) leaves out what its
/// version has no place for and writes zeros for what it wants and is `None`, so that one frame can be
/// sent to clients of different versions.
///
/// ```
/// use posewire_natnet::frame::{BodyParams, Frame, RigidBody};
/// use posewire_natnet::{Quirks, Version};
///
/// let sent = Frame {
///     number: 12,
///     rigid_bodies: vec![RigidBody {
///         id: 1,
///         position: [0.1, 1.5, -0.25],
///         params: Some(BodyParams::TRACKED),
///         ..RigidBody::default()
///     }],
///     ..Frame::default()
/// };
/// let mut payload = Vec::new();
/// sent.encode(Version::new(4, 1), &mut payload);
///
/// let mut frame = Frame::default();
/// let quirks = frame.decode_into(Version::new(4, 1), &payload)?;
/// assert_eq!(quirks, Quirks::NONE);
/// assert_eq!(frame.rigid_bodies[0].position, [0.1, 1.5, -0.25]);
/// assert_eq!(frame.rigid_bodies[0].is_tracked(), Some(true));
/// # Ok::<(), posewire_natnet::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    /// Number of the frame. It may repeat in live mode and goes back when a recording loops.
    pub number: i32,
    /// Markers by the set that they belong to; `all` holds those of every set.
    pub marker_sets: Vec<MarkerSet>,
    /// Positions of markers without a label, in metres. Superseded by the labeled markers.
    pub other_markers: Vec<[f32; 3]>,
    /// Rigid bodies.
    pub rigid_bodies: Vec<RigidBody>,
    /// Skeletons (2.1 and later).
    pub skeletons: Vec<Skeleton>,
    /// Assets: trained marker sets (4.1 and later).
    pub assets: Vec<Asset>,
    /// Markers with IDs (2.3 and later).
    pub labeled_markers: Vec<LabeledMarker>,
    /// Force plates (2.9 and later).
    pub force_plates: Vec<AnalogDevice>,
    /// Other analog devices (2.11 and later).
    pub devices: Vec<AnalogDevice>,
    /// Sections after the devices, as they came: IMUs and GPIO in 4.5, and whatever a later version
    /// adds.
    pub later_sections: Vec<OpaqueSection>,
    /// A number of the server's choice (before 3.0): Motive before 2.0 sends its software clock in
    /// seconds, or milliseconds. Not to be trusted as a latency.
    pub latency: Option<f32>,
    /// SMPTE timecode (2.3 and later).
    pub timecode: Option<Timecode>,
    /// Software clock of the server in seconds (2.6 and later; 32 bits in 2.6).
    pub timestamp: Option<f64>,
    /// When the cameras exposed and when the server received and sent (3.0 and later).
    pub host_stamps: Option<HostStamps>,
    /// Time of an external clock (4.1 and later).
    pub precision_time: Option<PrecisionTime>,
    /// Recording, model changed and more (2.6 and later).
    pub params: Option<FrameParams>,
}

/// A section that this crate does not read (4.1 and later).
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct OpaqueSection {
    /// How many records it says to have.
    pub count: i32,
    /// Its bytes.
    pub bytes: Vec<u8>,
}

/// Names of the sections in errors and explanations.
pub(crate) mod section {
    use crate::Version;

    pub(crate) const PREFIX: &str = "frame prefix";
    pub(crate) const MARKER_SETS: &str = "marker sets";
    pub(crate) const OTHER_MARKERS: &str = "other markers";
    pub(crate) const RIGID_BODIES: &str = "rigid bodies";
    pub(crate) const SKELETONS: &str = "skeletons";
    pub(crate) const ASSETS: &str = "assets";
    pub(crate) const LABELED_MARKERS: &str = "labeled markers";
    pub(crate) const FORCE_PLATES: &str = "force plates";
    pub(crate) const DEVICES: &str = "devices";
    pub(crate) const LATER: &str = "sections after the devices";
    pub(crate) const SUFFIX: &str = "frame suffix";
    /// Bytes of the suffix since 4.1.
    pub(crate) const SUFFIX_SIZE: usize = 54;

    /// Whether a suffix of so many bytes has a precision time. Documents and clients disagree about
    /// the versions from 3.0 to 4.0; the size tells.
    pub(crate) fn has_precision_time(version: Version, size: usize) -> bool {
        version.has_precision_time() || (version.has_host_stamps() && size == SUFFIX_SIZE)
    }
}

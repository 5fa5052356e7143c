//! Random frames and descriptions of a version: they hold what the version carries and nothing else.

use posewire_natnet::frame::{
    AnalogDevice, Asset, BodyMarker, BodyParams, Channel, Frame, FrameParams, HostStamps, LabeledMarker, MarkerParams,
    MarkerSet, OpaqueSection, PrecisionTime, RigidBody, Skeleton, Timecode,
};
use posewire_natnet::model::{
    AssetDescription, AssetMarker, BodyMarkerDescription, Camera, Description, Device, ForcePlate,
    MarkerSetDescription, Model, RigidBodyDescription, SkeletonDescription,
};
use posewire_natnet::{Name, Version};
use proptest::array::{uniform3, uniform4};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::select;

pub(crate) fn version() -> impl Strategy<Value = Version> {
    select(Version::LAYOUTS.to_vec())
}

/// A version and a frame of it.
pub(crate) fn frame() -> impl Strategy<Value = (Version, Frame)> {
    version().prop_flat_map(|version| (Just(version), frame_of(version)))
}

/// A version and descriptions of it.
pub(crate) fn model() -> impl Strategy<Value = (Version, Model)> {
    version().prop_flat_map(|version| {
        let known = move |one: &Description| one.is_in(version);
        let description = description(version).prop_filter("not in this version", known);
        let model = vec(description, 0..5).prop_map(|descriptions| Model { descriptions });
        (Just(version), model)
    })
}

pub(crate) fn name() -> impl Strategy<Value = Name> {
    vec(1..=255_u8, 0..6).prop_map(Name::new)
}

fn frame_of(version: Version) -> impl Strategy<Value = Frame> {
    (any::<i32>(), bodies(version), devices(version), suffix(version)).prop_map(|(number, bodies, devices, suffix)| {
        Frame {
            number,
            labeled_markers: devices.labeled_markers,
            force_plates: devices.force_plates,
            devices: devices.devices,
            later_sections: devices.later_sections,
            marker_sets: bodies.marker_sets,
            other_markers: bodies.other_markers,
            rigid_bodies: bodies.rigid_bodies,
            skeletons: bodies.skeletons,
            assets: bodies.assets,
            ..suffix
        }
    })
}

fn bodies(version: Version) -> impl Strategy<Value = Frame> {
    let sets = (name(), vec(position(), 0..3)).prop_map(|(name, markers)| MarkerSet { name, markers });
    let skeletons = (any::<i32>(), vec(body(version), 0..3)).prop_map(|(id, bones)| Skeleton { id, bones });
    (
        vec(sets, 0..3),
        vec(position(), 0..3),
        vec(body(version), 0..3),
        when(version.has_skeletons(), vec(skeletons, 0..3)),
        when(version.has_assets(), vec(asset(version), 0..3)),
    )
        .prop_map(|(marker_sets, other_markers, rigid_bodies, skeletons, assets)| Frame {
            marker_sets,
            other_markers,
            rigid_bodies,
            skeletons: skeletons.unwrap_or_default(),
            assets: assets.unwrap_or_default(),
            ..Frame::default()
        })
}

fn devices(version: Version) -> impl Strategy<Value = Frame> {
    let later = version.later_sections();
    let opaque = (any::<i32>(), vec(any::<u8>(), 0..20)).prop_map(|(count, bytes)| OpaqueSection { count, bytes });
    (
        when(version.has_labeled_markers(), vec(marker(version), 0..4)),
        when(version.has_force_plates(), vec(analog(), 0..3)),
        when(version.has_devices(), vec(analog(), 0..3)),
        vec(opaque, later),
    )
        .prop_map(|(markers, plates, devices, later_sections)| Frame {
            labeled_markers: markers.unwrap_or_default(),
            force_plates: plates.unwrap_or_default(),
            devices: devices.unwrap_or_default(),
            later_sections,
            ..Frame::default()
        })
}

fn suffix(version: Version) -> impl Strategy<Value = Frame> {
    let timecode = any::<(u32, u32)>().prop_map(|(code, subframe)| Timecode { code, subframe });
    let stamps = any::<(u64, u64, u64)>().prop_map(|(mid_exposure, data_received, transmit)| HostStamps {
        mid_exposure,
        data_received,
        transmit,
    });
    let precise = any::<(u32, u32)>().prop_map(|(seconds, fraction)| PrecisionTime { seconds, fraction });
    (
        when(version.has_latency(), number()),
        when(version.has_timecode(), timecode),
        when(version.has_timestamp(), number().prop_map(f64::from)),
        when(version.has_host_stamps(), stamps),
        when(version.has_precision_time(), precise),
        when(version.has_params(), any::<i16>().prop_map(FrameParams)),
    )
        .prop_map(
            |(latency, timecode, timestamp, host_stamps, precision_time, params)| Frame {
                latency,
                timecode,
                timestamp,
                host_stamps,
                precision_time,
                params,
                ..Frame::default()
            },
        )
}

fn body(version: Version) -> impl Strategy<Value = RigidBody> {
    let ids = version.has_body_marker_ids();
    let marker = (position(), when(ids, any::<i32>()), when(ids, number()))
        .prop_map(|(position, id, size)| BodyMarker { position, id, size });
    (
        any::<i32>(),
        position(),
        uniform4(number()),
        when(version.has_body_markers(), vec(marker, 0..3)),
        when(version.has_mean_error(), number()),
        when(version.has_params(), any::<i16>().prop_map(BodyParams)),
    )
        .prop_map(|(id, position, orientation, markers, mean_error, params)| RigidBody {
            id,
            position,
            orientation,
            markers: markers.unwrap_or_default(),
            mean_error,
            params,
        })
}

fn marker(version: Version) -> impl Strategy<Value = LabeledMarker> {
    (
        any::<i32>(),
        position(),
        number(),
        when(version.has_params(), any::<i16>().prop_map(MarkerParams)),
        when(version.has_residual(), number()),
    )
        .prop_map(|(id, position, size, params, residual)| LabeledMarker {
            id,
            position,
            size,
            params,
            residual,
        })
}

fn asset(version: Version) -> impl Strategy<Value = Asset> {
    (any::<i32>(), vec(body(version), 0..3), vec(marker(version), 0..3)).prop_map(|(id, rigid_bodies, markers)| Asset {
        id,
        rigid_bodies,
        markers,
    })
}

fn analog() -> impl Strategy<Value = AnalogDevice> {
    let channel = vec(number(), 0..4).prop_map(|samples| Channel { samples });
    (any::<i32>(), vec(channel, 0..3)).prop_map(|(id, channels)| AnalogDevice { id, channels })
}

fn description(version: Version) -> impl Strategy<Value = Description> {
    let set = (name(), vec(name(), 0..4)).prop_map(|(name, markers)| MarkerSetDescription { name, markers });
    let skeleton = (name(), any::<i32>(), vec(described_body(version), 0..3))
        .prop_map(|(name, id, bones)| SkeletonDescription { name, id, bones });
    let camera = (name(), position(), uniform4(number())).prop_map(|(name, position, orientation)| Camera {
        name,
        position,
        orientation,
    });
    let unknown = (7..i32::MAX, vec(any::<u8>(), 0..9)).prop_map(|(kind, bytes)| Description::Unknown { kind, bytes });
    prop_oneof![
        set.prop_map(Description::MarkerSet),
        described_body(version).prop_map(Description::RigidBody),
        skeleton.prop_map(Description::Skeleton),
        force_plate().prop_map(Description::ForcePlate),
        device().prop_map(Description::Device),
        camera.prop_map(Description::Camera),
        described_asset(version).prop_map(Description::Asset),
        unknown,
    ]
}

fn described_body(version: Version) -> impl Strategy<Value = RigidBodyDescription> {
    let named = version.names_body_markers();
    let marker = (position(), any::<i32>(), when(named, name())).prop_map(|(offset, active_label, name)| {
        BodyMarkerDescription {
            offset,
            active_label,
            name: name.unwrap_or_default(),
        }
    });
    (
        when(version.names_rigid_bodies(), name()),
        any::<(i32, i32)>(),
        position(),
        when(version.has_offset_orientation(), uniform4(number())),
        when(version.describes_body_markers(), vec(marker, 0..3)),
    )
        .prop_map(
            |(name, (id, parent_id), offset, offset_orientation, markers)| RigidBodyDescription {
                name: name.unwrap_or_default(),
                id,
                parent_id,
                offset,
                offset_orientation,
                markers: markers.unwrap_or_default(),
            },
        )
}

fn force_plate() -> impl Strategy<Value = ForcePlate> {
    let ids = any::<(i32, i32, i32)>();
    (
        ids,
        name(),
        uniform3(number()),
        vec(number(), 144),
        uniform4(position()),
        vec(name(), 0..3),
    )
        .prop_map(
            |((id, kind, channel_data), serial, origin, matrix, corners, channels)| {
                let mut plate = ForcePlate {
                    id,
                    serial,
                    width: origin[0],
                    length: origin[1],
                    origin,
                    corners,
                    kind,
                    channel_data,
                    channels,
                    ..ForcePlate::default()
                };
                plate.calibration.as_flattened_mut().copy_from_slice(&matrix);
                plate
            },
        )
}

fn device() -> impl Strategy<Value = Device> {
    (any::<(i32, i32, i32)>(), name(), name(), vec(name(), 0..3)).prop_map(
        |((id, kind, channel_data), name, serial, channels)| Device {
            id,
            name,
            serial,
            kind,
            channel_data,
            channels,
        },
    )
}

fn described_asset(version: Version) -> impl Strategy<Value = AssetDescription> {
    let marker =
        (name(), any::<i32>(), position(), number(), any::<i16>()).prop_map(|(name, id, position, size, params)| {
            AssetMarker {
                name,
                id,
                position,
                size,
                params: MarkerParams(params),
            }
        });
    (
        name(),
        any::<(i32, i32)>(),
        vec(described_body(version), 0..3),
        vec(marker, 0..3),
    )
        .prop_map(|(name, (kind, id), rigid_bodies, markers)| AssetDescription {
            name,
            kind,
            id,
            rigid_bodies,
            markers,
        })
}

fn position() -> impl Strategy<Value = [f32; 3]> {
    uniform3(number())
}

/// Any number that equals itself.
fn number() -> impl Strategy<Value = f32> {
    any::<f32>()
}

fn when<T: std::fmt::Debug>(there: bool, strategy: impl Strategy<Value = T>) -> impl Strategy<Value = Option<T>> {
    strategy.prop_map(move |value| there.then_some(value))
}

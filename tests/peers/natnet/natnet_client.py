"""The client natnet on PyPI, unicast or multicast."""

from natnet import NatNetClient
from watch import Watch


def main():
    watch = Watch()
    arguments = watch.arguments
    client = NatNetClient(
        server_ip_address=arguments.server,
        command_port=arguments.port,
        data_port=arguments.data_port,
        multicast_address=arguments.group or "239.255.42.99",
        use_multicast=arguments.group is not None,
    )
    client.on_data_frame_received_event.handlers.append(lambda frame: see(watch, frame))
    client.on_data_description_received_event.handlers.append(lambda model: name(watch, model))
    client.connect()
    client.request_modeldef()
    client.run_async()
    watch.wait()
    watch.report(str(client.protocol_version.truncate(2)))


def see(watch, frame):
    bodies = list(frame.rigid_bodies)
    for skeleton in frame.skeletons:
        bodies.extend(skeleton.rigid_bodies)
    watch.see(
        frame.prefix.frame_number,
        [(body.id_num, body.pos, body.rot) for body in bodies],
        [(marker.id_num, marker.pos) for marker in frame.labeled_markers],
        [(group.model_name, group.marker_pos_list) for group in frame.marker_sets],
    )


def name(watch, model):
    for skeleton in model.skeletons:
        watch.name(skeleton.name, [bone.name for bone in skeleton.rigid_body_descriptions])


main()

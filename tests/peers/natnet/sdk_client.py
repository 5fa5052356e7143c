"""The vendor's sample client, natnetsdk on PyPI, unicast: it asks for 4.1 and takes what the server tells it."""

from natnetsdk.NatNetClient import NatNetClient
from watch import Watch


def main():
    watch = Watch()
    client = NatNetClient()
    client.set_server_address(watch.arguments.server)
    client.command_port = watch.arguments.port
    client.set_use_multicast(False)
    client.set_print_level(0)
    listen(client, watch)
    client.run()
    watch.begun.wait(watch.patience)
    client.send_request(
        client.command_socket, client.NAT_REQUEST_MODELDEF, "", (client.server_ip_address, client.command_port)
    )
    watch.wait()
    watch.report(f"{client.get_major()}.{client.get_minor()}")


def listen(client, watch):
    """Sees what the client has unpacked: its listeners are told of bodies without their skeleton, and of no marker."""
    unpack_frame = client._NatNetClient__unpack_mocap_data
    unpack_model = client._NatNetClient__unpack_data_descriptions

    def unpacked_frame(*arguments):
        offset, frame = unpack_frame(*arguments)
        bodies = list(frame.rigid_body_data.rigid_body_list)
        for skeleton in frame.skeleton_data.skeleton_list:
            bodies.extend(skeleton.rigid_body_list)
        watch.see(
            frame.prefix_data.frame_number,
            [(body.id_num, body.pos, body.rot) for body in bodies],
            [(marker.id_num, marker.pos) for marker in frame.labeled_marker_data.labeled_marker_list],
            [(group.model_name, group.marker_pos_list) for group in frame.marker_set_data.marker_data_list],
        )
        return offset, frame

    def unpacked_model(*arguments):
        offset, model = unpack_model(*arguments)
        for skeleton in model.skeleton_list:
            watch.name(skeleton.name, [bone.sz_name for bone in skeleton.rigid_body_description_list])
        return offset, model

    client._NatNetClient__unpack_mocap_data = unpacked_frame
    client._NatNetClient__unpack_data_descriptions = unpacked_model


main()

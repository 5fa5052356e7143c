"""The vendor's sample, natnetsdk on PyPI, unicast: it asks for 4.1 and takes what the server tells it.

It starts as the sample does, which shows its configuration, and then changes versions as the sample's keys 3 and 4 do,
where the server lets it.
"""

from natnetsdk.__main__ import print_configuration
from natnetsdk.NatNetClient import NatNetClient
from watch import Watch


def main():
    watch = Watch()
    client = NatNetClient()
    client.set_server_address(watch.arguments.server)
    client.command_port = watch.arguments.port
    client.set_use_multicast(False)
    client.set_print_level(0)
    changing = Changing()
    listen(client, watch, changing)
    client.run()
    watch.begun.wait(watch.patience)
    print_configuration(client)
    if client.can_change_bitstream_version():
        changing.to(client, 3, 1)
        changing.to(client, 4, 1)
    client.send_request(
        client.command_socket, client.NAT_REQUEST_MODELDEF, "", (client.server_ip_address, client.command_port)
    )
    watch.wait()
    watch.report(f"{client.get_major()}.{client.get_minor()}")


class Changing:
    """Another version is asked for. The client reads all as the new one from the moment that it asks, also frames that are
    under way; no server can help that, so they are read here as what they are until the answer comes."""

    version = None
    """What frames still are."""

    def to(self, client, major, minor):
        self.version = (client.get_major(), client.get_minor())
        client.set_nat_net_version(major, minor)

    def note(self, client, data):
        """Sees a packet. Of the answers only those to commands, and not to the question, are numbers."""
        if data[:4] == bytes([client.NAT_RESPONSE, 0, 4, 0]):
            self.version = None


def listen(client, watch, changing):
    """Sees what the client has unpacked: its listeners are told of bodies without their skeleton, and of no marker."""
    unpack_frame = client._NatNetClient__unpack_mocap_data
    unpack_model = client._NatNetClient__unpack_data_descriptions
    process = client._NatNetClient__process_message

    def processed(data, *arguments):
        changing.note(client, data)
        return process(data, *arguments)

    def unpacked_frame(data, size, major, minor):
        offset, frame = unpack_frame(data, size, *(changing.version or (major, minor)))
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

    client._NatNetClient__process_message = processed
    client._NatNetClient__unpack_mocap_data = unpacked_frame
    client._NatNetClient__unpack_data_descriptions = unpacked_model


main()

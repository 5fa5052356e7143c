"""libmotioncapture, motioncapture on PyPI: rigid bodies alone, and no frame number.

It listens at the data port of all its addresses, for whatever the server sends there. Which frame it shows is told by
where the body is, as the take is never twice in one place. It shows the newest frame there is and passes over those
that came while it was not asked, which on a busy machine are many. They are not missing when a witness has them all.
"""

import motioncapture
import numpy  # The client loads it with the first position, while frames come.  # noqa: F401
from watch import Watch
from witness import Witness


def main():
    watch = Watch()
    arguments = watch.arguments
    numbers = {tuple(watch.take.poses(number)[0][0]): number for number in range(len(watch.take.frames))}
    witness = Witness(arguments)
    settings = {"hostname": arguments.server, "interface_ip": "127.0.0.1", "port_command": str(arguments.port)}
    client = motioncapture.connect("optitrack", settings)
    rounds, before, seen_before = 0, None, 0
    while not watch.done.is_set():
        client.waitForNextFrame()
        witness.read()
        for name, body in client.rigidBodies.items():
            position = tuple(float(part) for part in body.position)
            number = numbers.get(position, -1)
            if before is None:
                seen_before = len(witness.numbers)
            else:
                rounds += number < before
            before = number
            turn = [body.rotation.x, body.rotation.y, body.rotation.z, body.rotation.w]
            watch.see(rounds * len(numbers) + number, [(1, position, turn)])
            watch.name(name, watch.take.bones)
    if witness.has_all(seen_before + watch.arguments.frames):
        watch.passes_over = True
    watch.report("4.1")


main()

"""libmotioncapture, motioncapture on PyPI: rigid bodies alone, and no frame number.

It listens at the data port of all its addresses, for whatever the server sends there. Which frame it shows is told by
where the body is, as the take is never twice in one place. It shows the newest frame there is and passes over those
that came while it was not asked. They are not missing.
"""

import motioncapture
import numpy  # The client loads it with the first position, while frames come.  # noqa: F401
from watch import Watch


def main():
    watch = Watch()
    arguments = watch.arguments
    numbers = {tuple(watch.take.poses(number)[0][0]): number for number in range(len(watch.take.frames))}
    settings = {"hostname": arguments.server, "interface_ip": "127.0.0.1", "port_command": str(arguments.port)}
    client = motioncapture.connect("optitrack", settings)
    rounds, before = 0, None
    while not watch.done.is_set():
        client.waitForNextFrame()
        for name, body in client.rigidBodies.items():
            position = tuple(float(part) for part in body.position)
            number = numbers.get(position, -1)
            if before is not None:
                rounds += number < before
                watch.passed_over += (number - before - 1) % len(numbers)
            before = number
            turn = [body.rotation.x, body.rotation.y, body.rotation.z, body.rotation.w]
            watch.see(rounds * len(numbers) + number, [(1, position, turn)])
            watch.name(name, watch.take.bones)
    watch.report("4.1")


main()

"""The picture of the measurement on top of a page, drawn from the scenario's own values; none for formulas."""
from markupsafe import Markup

from . import bars, machine, mill, rod, socket, sphere
from .values import Values

DRAWN = {"rod_gauging": rod.picture, "tool_length": mill.picture, "sphere_calibration": sphere.picture,
         "sphere_probing": machine.picture, "single_socket": socket.socket, "single_socket_rotation": socket.turned,
         "laser_ball_bar": bars.picture}


def of(r):
    """(picture, caption), empty where there is nothing sensible to draw."""
    draw = DRAWN.get(r.model)
    if draw is None or not r.inputs:
        return "", ""
    picture, caption = draw(Values(r))
    return Markup(picture), caption

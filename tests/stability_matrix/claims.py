"""A claim of collapse put to the test: stresses that bear the weight disprove it, and ground of another stiffness may have some."""

import copy

import talus

COLLAPSE = "does not stand under its own weight"
DISPROVED = "; with one Young's modulus it stands"


def stands_with_one_modulus(scene):
    """Whether the scene begins once all its soils are as stiff as the first.

    Its stresses are then in equilibrium with the weight and within the strength, neither of which asks for the stiffness.
    """
    other = copy.deepcopy(scene)
    for soil in other["soils"]:
        soil["solid"]["youngModulus"] = other["soils"][0]["solid"]["youngModulus"]
    try:
        talus.Engine(talus.Scene.from_json(other)).close()
    except talus.Error:
        return False
    return True


def tested(scene, reason):
    """The reason of a refusal, marked where it is a claim that does not hold."""
    is_false = COLLAPSE in reason and len(scene["soils"]) > 1 and stands_with_one_modulus(scene)
    return reason.splitlines()[0] + DISPROVED if is_false else reason

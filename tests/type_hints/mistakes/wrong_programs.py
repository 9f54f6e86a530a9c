"""Mistakes that users make, each with what a type checker is to say of the line. Nobody runs this."""

from cramhy_runtime import cpl, kernel, testing
from cramhy_runtime.designators import Action, Motion, motion_grounding, replace
from cramhy_runtime.process_modules import execute, process_module
from cramhy_runtime.prolog import P, V, first, predicate, solve
from cramhy_runtime.ros.messages import RosMessage, message_class, service_type
from cramhy_runtime.ros import graph
from cramhy_runtime.testing import faults
from cramhy_runtime.turtlesim import executables, pictures


def drive(metres: float, speed: float = 0.5) -> str:
    return f"{metres / speed}"


distance = cpl.make_fluent(name="distance", value=3.0)
door = cpl.make_fluent(value=False)


def fluents() -> None:
    distance.value = "near"  # error: Incompatible types in assignment
    print(distance < "near")  # error: Unsupported operand types|No overload variant
    distance.valeu = 3  # error: "ValueFluent[float]" has no attribute "valeu"
    near = (distance < 1) & door.value  # error: Unsupported operand types for &
    arrived = distance > 5
    arrived.value = True  # error: Property "value" defined in "Notation" is read-only
    cpl.make_fluent(nmae="door")  # error: No overload variant of "make_fluent"
    cpl.wait_for(lambda: distance.value < 1)  # error: No overload variant of "wait_for"
    cpl.wait_for(door, time_out=3)  # error: Unexpected keyword argument "time_out"
    seen: bool = cpl.wait_for(door, timeout=3)  # error: Incompatible types in assignment
    print(near, seen)


def plans() -> int:
    cpl.run(drive)  # error: Argument 1 to "run" has incompatible type
    cpl.run(drive, "far")  # error: Argument 1 to "run" has incompatible type
    cpl.run(drive, 2.0, clock="virtaul")  # error: Argument "clock" to "run" has incompatible type
    cpl.par(drive(2), drive(3))  # error: No overload variant of "par"
    with cpl.par() as branches:
        branches.start(drive, "far")  # error: Argument 2 to "start" of "BranchBlock" has incompatible type "str"
        branches.start(drive, 1, sped=2)  # error: Unexpected keyword argument "sped" for "start"
        branches.start(drive(2))  # error: Argument 1 to "start" of "BranchBlock" has incompatible type "str"
        task = branches.start(drive, 1)
    cpl.evaporate(drive)  # error: Argument 1 to "__call__" of "Request" has incompatible type
    cpl.fail(ValueError("no"))  # error: No overload variant of "fail"
    return task.result  # error: Incompatible return value type (got "str", expected "int")


@cpl.plan_function
def fetch(thing: str) -> int:
    return len(thing)


def steps() -> None:
    fetch(3)  # error: Argument 1 to "fetch" has incompatible type "int"
    with cpl.timeout("3 s"):  # error: Argument 1 to "timeout" has incompatible type "str"
        pass
    for attempt in cpl.attempts(on=cpl.PlanFailure):  # error: Missing positional argument "count"
        print(attempt)
    cpl.make_policy("low", chek=lambda store: True)  # error: Unexpected keyword argument "chek" for "make_policy"
    kernel.start(backend="thread")  # error: Argument "backend" to "start" has incompatible type
    kernel.spawn(drive).join().upper()  # error: Argument 1 to "spawn" has incompatible type|Item "None" of "str | None"


class Driving(Motion):
    speed: float
    angle: float = 0.0


class Fetching(Action):
    thing: str


@motion_grounding(Driving)  # error: Argument 1 to "__call__" of "Grounds" has incompatible type
def wrong_grounding(action: Fetching) -> str:
    return action.thing


@process_module(Driving)
def base(motion: Driving) -> str:
    return motion.angel  # error: "Driving" has no attribute "angel"


def reasoning() -> None:
    Driving(sped=1.0)  # error: Unexpected keyword argument "sped" for "Driving"
    Driving()  # error: Missing named argument "speed" for "Driving"
    Driving(speed="fast")  # error: Argument "speed" to "Driving" has incompatible type "str"
    Motion(type="driving")  # error: Argument "type" to "Motion" has incompatible type "str"
    replace(Driving(speed=1), speed=2).thing  # error: "Driving" has no attribute "thing"
    solve(P.parent)  # error: Argument 1 to "solve" has incompatible type "Name"
    solve(V.x == 3)  # error: Argument 1 to "solve" has incompatible type "bool"
    first(P.parent(V.x)).x  # error: Item "None" of "Answer | None" has no attribute "x"
    number: int = execute(base, Driving(speed=1.0))  # error: Incompatible types in assignment
    predicate(3)  # error: No overload variant of "predicate"|Value of type variable "F"
    print(number)


def of_tests() -> None:
    testing.run(drive)  # error: Argument 1 to "run" has incompatible type
    testing.run(fluents, faults=[faults.at(action="kill")])  # error: Argument "action" to "at" has incompatible type
    testing.assert_order(["a"], ("a", "b"))  # error: Argument 1 to "assert_order" has incompatible type


def ros() -> None:
    node = graph.active().node("wrong", spin=True)  # error: Unexpected keyword argument "spin" for "node"
    node.subscribe("/pose", "turtlesim/Pose", print)  # error: Argument 2 to "subscribe" of "Node" has incompatible type "str"
    node.serve("~stop", service_type("std_srvs/Empty"), lambda request: "done")  # error: Incompatible return value type
    node.advertise("/pose", message_class("turtlesim/Pose")).publish("here")  # error: Argument 1 to "publish"
    graph.active().parameters.set("/x", object())  # error: Argument 2 to "set" of "ParameterTree"
    simulator = executables.start("turtlesim_node")
    simulator.observe(lambda simulator: None)  # error: Argument 1 to "observe" of "Turtlesim"|Cannot infer type of lambda
    simulator.turtle["turtle1"]  # error: "Turtlesim" has no attribute "turtle"
    pictures.save(simulator)  # error: Argument 1 to "save" has incompatible type "Turtlesim"


def read(pose: RosMessage) -> str:
    return pose.fields  # error: Incompatible return value type

// What the npm package roslib does with a running session: it drives the turtle, calls services, offers one, and asks for what there is.
// Argument: the address of the session. Each finding is printed as one line of JSON.
import { Param, Ros, Service, Topic } from "roslib";

const ros = new Ros({ url: process.argv[2] });
const told = (name, value) => console.log(JSON.stringify([name, value]));
const call = (name, serviceType, request = {}) =>
  new Promise((done) => new Service({ ros, name, serviceType }).callService(request, done, (problem) => done({ refused: problem })));
const ask = (method, ...parameters) =>
  new Promise((done, failed) => ros[method](...parameters, done, failed));

await new Promise((done, failed) => { ros.on("connection", done); ros.on("error", failed); });

// topics
const pose = new Topic({ ros, name: "/turtle1/pose", messageType: "turtlesim/Pose", throttle_rate: 20, queue_length: 1 });
const velocity = new Topic({ ros, name: "/turtle1/cmd_vel", messageType: "geometry_msgs/Twist" });
const first = await new Promise((done) => pose.subscribe(done));
told("first", first);
velocity.publish({ linear: { x: 2, y: 0, z: 0 }, angular: { x: 0, y: 0, z: 1 } });
pose.unsubscribe();
told("moved", await new Promise((done) => pose.subscribe((message) => message.x > first.x + 0.3 && done(message.x > first.x))));
pose.unsubscribe();
velocity.unadvertise();

// each way to pack messages
for (const compression of ["png", "cbor"]) {
  const packed = new Topic({ ros, name: "/turtle1/pose", messageType: "turtlesim/Pose", compression, throttle_rate: 20, queue_length: 1 });
  told(compression, Object.keys(await new Promise((done) => packed.subscribe(done))));
  packed.unsubscribe();
}

// services
told("spawn", await call("/spawn", "turtlesim/Spawn", { x: 2, y: 3, theta: 0, name: "anna" }));
told("pen", await call("/anna/set_pen", "turtlesim/SetPen", { r: 255, g: 0, b: 0, width: 5, off: 0 }));
told("teleport", await call("/anna/teleport_absolute", "turtlesim/TeleportAbsolute", { x: 7, y: 8, theta: 0 }));
told("relative", await call("/anna/teleport_relative", "turtlesim/TeleportRelative", { linear: 1, angular: 0 }));
told("kill", await call("/kill", "turtlesim/Kill", { name: "anna" }));
told("killed", await call("/kill", "turtlesim/Kill", { name: "anna" }));
told("clear", await call("/clear", "std_srvs/Empty"));
told("reset", await call("/reset", "std_srvs/Empty"));

// what there is
told("topics", (await ask("getTopics")).topics.includes("/turtle1/pose"));
told("types", (await ask("getTopicsAndRawTypes")).typedefs_full_text.length > 0);
told("for type", await ask("getTopicsForType", "turtlesim/Color"));
told("topic type", await ask("getTopicType", "/turtle1/cmd_vel"));
told("services", (await ask("getServices")).includes("/spawn"));
told("services for type", await ask("getServicesForType", "turtlesim/Spawn"));
told("service type", await ask("getServiceType", "/turtle1/set_pen"));
told("request", (await ask("getServiceRequestDetails", "turtlesim/Spawn")).typedefs[0].fieldnames);
told("response", (await ask("getServiceResponseDetails", "turtlesim/Spawn")).typedefs[0].fieldnames);
told("message", ros.decodeTypeDefs(await ask("getMessageDetails", "geometry_msgs/Twist")));
told("nodes", (await ask("getNodes")).includes("/turtlesim"));
told("node", (await new Promise((done, failed) => ros.getNodeDetails("/turtlesim", (...found) => done(found[0]), failed))));
told("actions", await ask("getActionServers"));

// parameters
const param = new Param({ ros, name: "/turtlesim/background_r" });
await new Promise((done) => param.set(200, done));
told("param", await new Promise((done) => param.get(done)));
told("params", (await ask("getParams")).includes("/turtlesim/background_g"));
await new Promise((done) => new Param({ ros, name: "/turtlesim/background_r" }).delete(done));

// a service for the plan
const sum = new Service({ ros, name: "/sum", serviceType: "roscpp_tutorials/TwoInts" });
const asked = new Promise((done) => sum.advertise((request, response) => {
  response.sum = request.a + request.b;
  setTimeout(done, 0, [request.a, request.b]);
  return true;
}));
told("asked", await asked);
told("answered", (await call("/rosapi/get_time", "rosapi/GetTime")).time.secs > 0);
await sum.unadvertise();
ros.close();

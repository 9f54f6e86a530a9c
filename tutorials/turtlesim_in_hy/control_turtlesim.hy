(require cramhy *)
(import types [SimpleNamespace])

(setv color-value (make-fluent :name 'color-value)  ; current color under the turtle
      turtle-pose (make-fluent :name 'turtle-pose)  ; current pose of turtle

      turtle (SimpleNamespace
               :color-sub None     ; color ROS subscriber
               :pose-sub None      ; pose ROS subscriber
               :cmd-vel-pub None   ; velocity commands ROS publisher
               :pen-srv None))     ; name of ROS service for controlling the pen

(defn init-ros-turtle [name]
  "Subscribes to topics for a turtle and binds callbacks.
  'name' specifies the name of the turtle."

  (setv turtle.color-sub (subscribe f"{name}/color_sensor"
                                    "turtlesim/Color"
                                    color-cb)

        turtle.pose-sub (subscribe f"{name}/pose"
                                   "turtlesim/Pose"
                                   pose-cb)

        turtle.cmd-vel-pub (advertise f"{name}/cmd_vel"
                                      "geometry_msgs/Twist")

        turtle.pen-srv f"/{name}/set_pen"))

(defn color-cb [msg]
  "Callback for color values. Called by the color topic subscriber."
  (setv color-value.value msg))

(defn pose-cb [msg]
  "Callback for pose values. Called by the pose topic subscriber."
  (setv turtle-pose.value msg))

(defn send-vel-cmd [lin ang]
  "Function to send velocity commands."
  (publish turtle.cmd-vel-pub
    ;; short syntax:
    ;; (make-message "geometry_msgs/Twist" (:x :linear) lin (:z :angular) ang)
    ;; more understandable syntax:
    (make-message "geometry_msgs/Twist"
      :linear (make-msg "geometry_msgs/Vector3" :x lin)
      :angular (make-msg "geometry_msgs/Vector3" :z ang))))

(defn call-set-pen [r g b width off]
  "Function to call the SetPen service."
  (call-service turtle.pen-srv "turtlesim/SetPen"
    :r r
    :g g
    :b b
    :width width
    :off off))

(defn call-clear-background []
  "Function to call the service that wipes the turtle's paper."
  (call-service "/clear" "std_srvs/Empty"))

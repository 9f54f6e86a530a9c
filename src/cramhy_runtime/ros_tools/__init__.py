"""The ROS command-line tools: ``rosnode``, ``rostopic``, ``rosservice``, ``rosparam``, ``rosmsg``, ``rossrv``.

They print what the originals print (roslisp.md 14.2), and work on the graph of this process, for a command typed at the prompt, or from
another terminal on the session that serves there. Importing this package, and a command from another terminal, load no Lisp.

Where the parts are:

* `running`      a command from its words to its exit status, and the terminal it writes to
* `arguments`        commands, options, usage; `definitions` and `filling` types, and data that fit them
* `yaml_reading`  values as they are typed, with `yaml_library`, which is PyYAML; `message_text` messages as they are printed
* `nodes`, `topics`, `topic_echo`, `publishing`, `calling`, `parameters`, `types`  the commands
* `graph_access`        what they ask of a graph; `local_graph` the graph of this process, `remote_graph` the session of another terminal
* `hosting`      programs that run in a session for a terminal elsewhere; `executables` which there are
"""

#!/usr/bin/env python3
"""Let SBCL write the answers of a list of typed forms, with the libraries of a checkout of roslisp_common and with Debian's roslisp.

    apt-get download roslisp cl-tf cl-{actionlib,actionlib-msgs,geometry-msgs,nav-msgs,rosgraph-msgs,std-msgs,std-srvs,tf2-msgs} \\
        python3-{catkin-pkg,defusedxml,genmsg,genpy,rosgraph,rosgraph-msgs,rosmaster,rospkg}
    for package in *.deb; do dpkg -x $package root; done
    cp -rL /usr/share/common-lisp/source/alexandria root
    export ROS_IP=127.0.0.1 ROS_MASTER_URI=http://127.0.0.1:11355
    PYTHONPATH=root/usr/lib/python3/dist-packages root/usr/bin/rosmaster --core -p 11355 &
    ROSLISP=root CRAMHY_APPLICATIONS=CHECKOUTS python3 record.py typed/cl_transforms_stamped.lisp alexandria cl-transforms-stamped
    ROSLISP=root CRAMHY_APPLICATIONS=CHECKOUTS python3 record.py typed/cl_tf2.lisp alexandria cl-tf2 tf2_msgs-msg
    ROSLISP=root CRAMHY_APPLICATIONS=CHECKOUTS python3 record.py typed/actionlib_lisp.lisp alexandria actionlib actionlib-lisp actionlib-msg
    ROSLISP=root CRAMHY_APPLICATIONS=CHECKOUTS python3 record.py typed/actionlib.lisp alexandria actionlib actionlib-msg

The forms of the file stay; what stands behind ``;=>`` is written anew, or behind ``;~>`` where cramhy differs. The systems behind the file's name are loaded before, with the compiler quiet. Three recordings of 28 November 2026 gave
the same answers.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path
from xmlrpc.client import ServerProxy

PREAMBLE = """
(require :asdf) (require :sb-concurrency) (require :sb-bsd-sockets) (require :sb-posix)
(setf *compile-verbose* nil *load-verbose* nil *compile-print* nil)
(dolist (folder '(FOLDERS))
  (dolist (file (directory (concatenate 'string folder "/**/*.asd")))
    (pushnew (make-pathname :name nil :type nil :version nil :defaults file) asdf:*central-registry* :test #'equal)))
;; It asks rospack, and walks up from a system to a manifest, which Debian's messages do not have.
(asdf:register-preloaded-system "ros-load-manifest")
(defpackage :ros-load-manifest (:nicknames :ros-load) (:use :cl)
  (:export #:*current-ros-package* #:asdf-ros-search #:ros-home #:ros-package-path #:rospack))
(handler-bind ((warning #'muffle-warning))
  (let ((*standard-output* (make-broadcast-stream)))
    (dolist (system '(SYSTEMS)) (asdf:load-system system))))
(with-open-file (in SOURCE)
  (loop for form = (read in nil in) until (eq form in) do
    (let ((value (handler-case (prin1-to-string (eval form)) (error (e) (format nil "~a: ~a" (type-of e) e)))))
      (format t "~&@@~a~%" (substitute #\\space #\\newline value)) (finish-output))))
(sb-ext:exit :code 0 :abort t)
"""


def main(path: Path, systems: list[str]) -> None:
    """Write the answers into the file at ``path``; ``systems`` are loaded before its first form."""
    # roslisp cannot read an empty list of parameters, which no master has that roslaunch started.
    ServerProxy(os.environ["ROS_MASTER_URI"]).setParam("/record", "/rosdistro", "noetic")
    blocks = [block.partition("\n;=> ") for block in path.read_text(encoding="utf-8").strip().split("\n\n")]
    forms = [form for form, _, _ in blocks]
    folders = [os.environ["ROSLISP"], os.environ["CRAMHY_APPLICATIONS"] + "/roslisp_common"]
    with tempfile.TemporaryDirectory() as folder:
        source, program = Path(folder, "forms.lisp"), Path(folder, "program.lisp")
        source.write_text("\n".join(forms), encoding="utf-8")
        text = PREAMBLE.replace("FOLDERS", " ".join(f'"{os.path.abspath(name)}"' for name in folders))
        text = text.replace("SYSTEMS", " ".join(f'"{name}"' for name in systems)).replace("SOURCE", f'"{source}"')
        program.write_text(text, encoding="utf-8")
        done = subprocess.run(["timeout", "120", "sbcl", "--script", program], capture_output=True, text=True)
    answers = [" ".join(line[2:].split()) for line in done.stdout.splitlines() if line.startswith("@@")]
    if len(answers) != len(forms):
        sys.exit(f"{len(answers)} answers to {len(forms)} forms\n{done.stdout[-2000:]}\n{done.stderr[:1500]}")
    answers = [re.sub(r"([][.*+?^$|(){}\\])", r"\\\1", answer) for answer in answers]
    written = []
    for (form, _, before), answer in zip(blocks, answers, strict=True):
        ours, differs, _ = before.partition("\n;~> ")
        written.append(f"{form}\n;=> {ours}{differs}{answer}" if differs else f"{form}\n;=> {answer}")
    path.write_text("\n\n".join(written) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2:])

"""Scenario files of small articulated robots, one in the plane and one in space."""

PLANAR = """\
format: 1
name: hinge
dimension: 2
bounds: {low: [-50, -40], high: [50, 40]}
robot:
  base: free
  links:
    - name: head
      parts:
        - {name: face, semi_axes: [5, 3]}
    - name: ear
      parts:
        - {semi_axes: [3, 1], position: [3, 0]}
  joints:
    - name: ear
      type: revolute
      parent: head
      child: ear
      origin: {position: [-6, 2], orientation: {yaw_deg: 90}}
      limit: {lower_deg: 0, upper_deg: 90}
start: {position: [-40, 0], orientation: {yaw_deg: 0}, joints: {ear_deg: 30}}
goal: {position: [40, 10], orientation: {yaw_deg: 30}}
"""
SPATIAL = """\
format: 1
name: arm
dimension: 3
bounds: {low: [-5, -5, -5], high: [5, 5, 5]}
robot:
  base: fixed
  links:
    - name: foot
    - name: arm
      parts:
        - {semi_axes: [1, 0.2, 0.2], position: [1.2, 0, 0]}
    - name: hand
      parts:
        - {semi_axes: [0.5, 0.2, 0.1], position: [0.6, 0, 0]}
    - name: finger
      parts:
        - {semi_axes: [0.5, 0.2, 0.1], position: [0.6, 0, 0]}
  joints:
    - name: shoulder
      type: ball
      parent: foot
      child: arm
    - name: wrist
      type: continuous
      parent: arm
      child: hand
      origin: {position: [2.4, 0, 0]}
      axis: [1, 1, 1]
    - name: slide
      type: prismatic
      parent: hand
      child: finger
      origin: {position: [1.2, 0, 0], orientation: {rpy_deg: [10, 20, 30]}}
      axis: [0, 2, 1]
      limit: {lower: -0.1, upper: 0.4}
  ignore_self_collision: [[hand, foot], [finger, arm]]
start:
  position: [0, 0, 1]
  orientation: {axis_angle: {axis: [1, 2, 3], angle_deg: 20}}
  joints:
    shoulder: {rpy_deg: [10, 20, 30]}
    wrist_deg: 270
    slide: 0.33
goal:
  joints: {wrist_deg: 17}
"""

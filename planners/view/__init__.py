"""What people look at: meshcat pages and matplotlib figures.

`meshcat_page.scene_html` makes a page with a scene in it and `figures.figure` a picture. Both
import their library only when they are called.
"""

"""What people look at: meshcat pages and matplotlib figures.

`show.show` opens a page with a scenario in it, and a path if there is one; `meshcat_page` and
`figures` have the pieces. All of them import their library only when they are called.
"""

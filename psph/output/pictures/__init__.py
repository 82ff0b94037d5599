"""Pictures of a run: pages of panels, charts and films; the room is imported where something is drawn."""

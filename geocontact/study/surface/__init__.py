"""Statistics on surfaces whose points correspond from subject to subject."""

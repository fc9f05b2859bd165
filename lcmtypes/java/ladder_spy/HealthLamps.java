// SPDX-License-Identifier: BSD-3-Clause
package ladder_spy;

import java.awt.Color;
import java.awt.Dimension;
import java.awt.Graphics2D;
import java.util.Map;
import java.util.TreeMap;
import javax.swing.Action;
import javax.swing.JDesktopPane;

import ladder_msgs.health_t;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;

/** lcm-spy plugin: a lamp per service. Green works, blue waits for input, yellow degraded or losing messages, red silent for two seconds. */
public final class HealthLamps implements SpyPlugin {
    private static final String[] NAMES = {"?", "sensor", "gng", "ladder", "climb", "simulator", "viewer"};
    private static final long SILENT_MS = 2000;
    private static final int ROW_PX = 34;

    @Override
    public boolean canHandle(long fingerprint) {
        return fingerprint == health_t.LCM_FINGERPRINT;
    }

    @Override
    public Action getAction(JDesktopPane desktop, ChannelData channel) {
        return LiveView.opener("Health", desktop, channel, View::new);
    }

    /** What was heard last of one service. */
    private static final class Lamp {
        health_t message;
        long heardMs;
        long lostBefore;
        long lost;
    }

    /** All services share the channel, so it looks often and keeps the newest of each. */
    private static final class View extends LiveView {
        private final Map<Byte, Lamp> lamps = new TreeMap<>();

        View(ChannelData channel) {
            super(channel, 20, new Dimension(760, 6 * ROW_PX + 10));
        }

        @Override
        protected void refresh() {
            collect(System.currentTimeMillis());
            repaint();
        }

        private void collect(long nowMs) {
            if (!(channel.last instanceof health_t)) return;
            final health_t message = (health_t) channel.last;
            final Lamp lamp = lamps.computeIfAbsent(message.service, service -> new Lamp());
            if (lamp.message == message) return;
            lamp.lostBefore = lamp.message == null ? lostOf(message) : lamp.lost;
            lamp.message = message;
            lamp.lost = lostOf(message);
            lamp.heardMs = nowMs;
        }

        private static long lostOf(health_t message) {
            long lost = 0;
            for (int i = 0; i < message.num_inputs; ++i) lost += message.input_lost[i];
            return lost;
        }

        @Override
        protected void draw(Graphics2D graphics) {
            collect(System.currentTimeMillis());
            int y = ROW_PX;
            for (Lamp lamp : lamps.values()) {
                final boolean isSilent = System.currentTimeMillis() - lamp.heardMs > SILENT_MS;
                graphics.setColor(colorOf(lamp, isSilent));
                graphics.fillOval(12, y - 18, 20, 20);
                graphics.setColor(Color.LIGHT_GRAY);
                graphics.drawString(textOf(lamp, isSilent), 44, y - 3);
                y += ROW_PX;
            }
        }

        private static Color colorOf(Lamp lamp, boolean isSilent) {
            if (isSilent) return new Color(220, 50, 50);
            final boolean isLosing = lamp.lost > lamp.lostBefore;
            if (lamp.message.state == health_t.STATE_DEGRADED || lamp.message.flags != 0 || isLosing) return new Color(230, 200, 60);
            return lamp.message.state == health_t.STATE_WORKING ? new Color(60, 190, 80) : new Color(80, 130, 220);
        }

        private static String textOf(Lamp lamp, boolean isSilent) {
            final health_t m = lamp.message;
            final String name = m.service >= 0 && m.service < NAMES.length ? NAMES[m.service] : "service " + m.service;
            if (isSilent) return name + ": silent";
            final String state = m.state == health_t.STATE_WORKING ? "works" : m.state == health_t.STATE_WAITING ? "waits for input"
                               : m.state == health_t.STATE_DEGRADED ? "degraded" : "stopping";
            int age = -1;
            for (int i = 0; i < m.num_inputs; ++i) age = Math.max(age, m.input_age_p99_us[i]);
            return name + ": " + state + ", lost " + lamp.lost + (age >= 0 ? ", input at most " + age / 1000 + " ms old" : "") + flagsOf(m.flags);
        }

        private static String flagsOf(long flags) {
            String text = "";
            if ((flags & health_t.FLAG_SMALL_SOCKET_BUFFER) != 0) text += ", socket buffer too small";
            if ((flags & health_t.FLAG_HEAD_DEAD) != 0) text += ", a head is dead";
            if ((flags & health_t.FLAG_NO_ODOMETRY) != 0) text += ", no odometry";
            if ((flags & health_t.FLAG_NO_GRAVITY) != 0) text += ", no gravity";
            if ((flags & health_t.FLAG_PUBLISH_FAILED) != 0) text += ", publishing failed";
            return text;
        }
    }
}
